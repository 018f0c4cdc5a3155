// HDF5 files: every data set of numbers below the root, in any group.
#define H5_USE_110_API  // names and types of version 1.10, which later versions offer as well
#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <array>
#include <utility>

#include "host/exit_codes.hpp"
#include "host/import/confined_reader.hpp"
#include "host/import/log_file.hpp"
#include "host/import/reader_library.hpp"
#include "host/input_limits.hpp"

namespace host {

namespace {

constexpr unsigned kReadOnly = 0;  // H5F_ACC_RDONLY; its macro would call the library

struct Hdf5Library {
  explicit Hdf5Library(const ReaderLibrary& library) {
    library.find(open, "H5open");
    library.find(set_error_printer, "H5Eset_auto2");
    library.find(load_no_plugins, "H5PLset_loading_state");
    library.find(open_file, "H5Fopen");
    library.find(visit, "H5Ovisit1");
    library.find(open_object, "H5Oopen");
    library.find(close_object, "H5Oclose");
    library.find(space_of, "H5Dget_space");
    library.find(type_of, "H5Dget_type");
    library.find(plan_of, "H5Dget_create_plist");
    library.find(read, "H5Dread");
    library.find(layout_of, "H5Pget_layout");
    library.find(outer_files, "H5Pget_external_count");
    library.find(close_plan, "H5Pclose");
    library.find(rank_of, "H5Sget_simple_extent_ndims");
    library.find(sizes_of, "H5Sget_simple_extent_dims");
    library.find(points_of, "H5Sget_simple_extent_npoints");
    library.find(close_space, "H5Sclose");
    library.find(class_of, "H5Tget_class");
    library.find(size_of, "H5Tget_size");
    library.find(field_count, "H5Tget_nmembers");
    library.find(field_name, "H5Tget_member_name");
    library.find(field_type, "H5Tget_member_type");
    library.find(make_type, "H5Tcreate");
    library.find(insert_field, "H5Tinsert");
    library.find(is_pointer_to_text, "H5Tis_variable_str");
    library.find(close_type, "H5Tclose");
    library.find(has_attribute, "H5Aexists");
    library.find(open_attribute, "H5Aopen");
    library.find(space_of_attribute, "H5Aget_space");
    library.find(type_of_attribute, "H5Aget_type");
    library.find(read_attribute, "H5Aread");
    library.find(close_attribute, "H5Aclose");
    library.find(free_memory, "H5free_memory");
    library.find(a_double, "H5T_NATIVE_DOUBLE_g");
  }

  decltype(&H5open) open = nullptr;
  decltype(&H5Eset_auto2) set_error_printer = nullptr;
  decltype(&H5PLset_loading_state) load_no_plugins = nullptr;
  decltype(&H5Fopen) open_file = nullptr;
  decltype(&H5Ovisit1) visit = nullptr;
  decltype(&H5Oopen) open_object = nullptr;
  decltype(&H5Oclose) close_object = nullptr;
  decltype(&H5Dget_space) space_of = nullptr;
  decltype(&H5Dget_type) type_of = nullptr;
  decltype(&H5Dget_create_plist) plan_of = nullptr;
  decltype(&H5Dread) read = nullptr;
  decltype(&H5Pget_layout) layout_of = nullptr;
  decltype(&H5Pget_external_count) outer_files = nullptr;
  decltype(&H5Pclose) close_plan = nullptr;
  decltype(&H5Sget_simple_extent_ndims) rank_of = nullptr;
  decltype(&H5Sget_simple_extent_dims) sizes_of = nullptr;
  decltype(&H5Sget_simple_extent_npoints) points_of = nullptr;
  decltype(&H5Sclose) close_space = nullptr;
  decltype(&H5Tget_class) class_of = nullptr;
  decltype(&H5Tget_size) size_of = nullptr;
  decltype(&H5Tget_nmembers) field_count = nullptr;
  decltype(&H5Tget_member_name) field_name = nullptr;
  decltype(&H5Tget_member_type) field_type = nullptr;
  decltype(&H5Tcreate) make_type = nullptr;
  decltype(&H5Tinsert) insert_field = nullptr;
  decltype(&H5Tis_variable_str) is_pointer_to_text = nullptr;
  decltype(&H5Tclose) close_type = nullptr;
  decltype(&H5Aexists) has_attribute = nullptr;
  decltype(&H5Aopen) open_attribute = nullptr;
  decltype(&H5Aget_space) space_of_attribute = nullptr;
  decltype(&H5Aget_type) type_of_attribute = nullptr;
  decltype(&H5Aread) read_attribute = nullptr;
  decltype(&H5Aclose) close_attribute = nullptr;
  decltype(&H5free_memory) free_memory = nullptr;
  hid_t* a_double = nullptr;  ///< type of a double, once the library is open
};

const Hdf5Library& hdf5_library() {
  static const Hdf5Library library{ReaderLibrary("HDF5 files", kHdf5)};
  return library;
}

/// An object of the library that is closed by the destructor.
class Hdf5Object {
 public:
  Hdf5Object(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Hdf5Object(const Hdf5Object&) = delete;
  Hdf5Object& operator=(const Hdf5Object&) = delete;
  ~Hdf5Object() {
    if (id_ >= 0) close_(id_);
  }
  bool is_open() const { return id_ >= 0; }
  operator hid_t() const { return id_; }  // NOLINT(google-explicit-constructor): the library's functions take it

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

class Hdf5Reader {
 public:
  explicit Hdf5Reader(const std::string& path) : h5_(hdf5_library()) {
    log_.path = path;
    log_.layout = "hdf5";
  }

  Log read() {
    h5_.open();
    h5_.set_error_printer(H5E_DEFAULT, nullptr, nullptr);  // failures are reported by exceptions
    h5_.load_no_plugins(0);
    const hid_t file = h5_.open_file(log_.path.c_str(), kReadOnly, H5P_DEFAULT);
    if (file < 0)
      throw Failure(ExitCode::bad_input,
                    fmt::format("{}: not an HDF5 file that can be read: cut off, or still open in the program that "
                                "writes it; save it again",
                                log_.path));
    // Visits every object once and by hard links only, so that there are neither cycles nor other files.
    const herr_t visited = h5_.visit(
        file, H5_INDEX_NAME, H5_ITER_INC,
        [](hid_t root, const char* name, const H5O_info_t* info, void* self) {
          static_cast<Hdf5Reader*>(self)->add_object(root, name, info->type);
          return herr_t{0};
        },
        this);
    if (!refusal_.empty()) throw Failure(ExitCode::bad_input, refusal_);
    if (visited < 0 && log_.columns.empty())
      throw Failure(ExitCode::bad_input, fmt::format("{}: its groups are damaged; save it again", log_.path));
    if (log_.columns.empty())
      throw Failure(ExitCode::bad_input,
                    fmt::format("{}: the file holds no data sets; save the log in one", log_.path));
    return std::move(log_);
  }

 private:
  /// Exceptions must not pass through the library.
  void add_object(hid_t root, const char* name, H5O_type_t type) {
    if (!refusal_.empty()) return;
    try {
      if (++objects_ > kMostObjects)
        throw Failure(ExitCode::bad_input, fmt::format("{}: more than {} groups and data sets, the most that a log may "
                                                       "have; save those of the log",
                                                       log_.path, kMostObjects));
      const Hdf5Object object(h5_.open_object(root, name, H5P_DEFAULT), h5_.close_object);
      if (!object.is_open()) return;
      take_period(object);
      if (type == H5O_TYPE_DATASET) add_data_set(object, name);
    } catch (const std::bad_alloc&) {
      refusal_ = fmt::format("{}: '{}' takes more memory than a log may; save fewer rows", log_.path, name);
    } catch (const std::exception& failure) {
      refusal_ = failure.what();
    }
  }

  void add_data_set(hid_t set, const std::string& name) {
    const Hdf5Object space(h5_.space_of(set), h5_.close_space), type(h5_.type_of(set), h5_.close_type);
    const int rank = h5_.rank_of(space);
    std::array<hsize_t, H5S_MAX_RANK> sizes{1, 1};
    if (rank > 0) h5_.sizes_of(space, sizes.data(), nullptr);
    std::string shape;
    for (int k = 0; k < rank; ++k)
      shape += fmt::format("{}{}", k == 0 ? "" : " x ", sizes[static_cast<std::size_t>(k)]);
    const H5T_class_t kind = h5_.class_of(type);
    const int fields = kind == H5T_COMPOUND ? h5_.field_count(type) : 1;
    if (rank < 1 || rank > 2 || lies_elsewhere(set) || (fields > 1 && rank == 2 && sizes[1] > 1)) {
      leave(name, rank < 1 ? "a single value" : shape,
            lies_elsewhere(set) ? "lies in another file; copy it into this one (h5repack)"
                                : "is not a table of rows and columns; name another");
      return;
    }
    announced_ += static_cast<double>(sizes[0]) * static_cast<double>(sizes[1]) * fields;
    if (!(announced_ <= static_cast<double>(kMostLogNumbers)))
      throw Failure(ExitCode::bad_input, fmt::format("{}: with '{}' it holds more than {} numbers, the most that a log "
                                                     "may have; save fewer data sets or rows",
                                                     log_.path, name, kMostLogNumbers));
    std::vector<std::string> units = texts_of(set, "units");
    if (units.empty()) units = texts_of(set, "unit");
    if (kind != H5T_COMPOUND) {
      const hid_t memory = is_number(type) ? *h5_.a_double : -1;
      add_array(set, {name, fmt::format("{}, {}", kind_name(type), shape), units}, memory, sizes[0], sizes[1]);
      return;
    }
    for (unsigned k = 0; k < static_cast<unsigned>(fields); ++k) {
      char* const field_name = h5_.field_name(type, k);
      if (field_name == nullptr) continue;
      const Hdf5Object field(h5_.field_type(type, k), h5_.close_type);
      const Hdf5Object alone(h5_.make_type(H5T_COMPOUND, sizeof(double)), h5_.close_type);
      h5_.insert_field(alone, field_name, 0, *h5_.a_double);
      add_array(set,
                {fmt::format("{}.{}", name, field_name), fmt::format("{}, {}", kind_name(field), shape),
                 units.size() > 1 ? std::vector{unit_at(units, k)} : units},
                is_number(field) ? static_cast<hid_t>(alone) : -1, sizes[0], sizes[1]);
      h5_.free_memory(field_name);
    }
  }

  struct Label {
    std::string name, kind;
    std::vector<std::string> units;
  };

  /// `memory`: the type in which the numbers are read; negative if the array does not contain numbers.
  void add_array(hid_t set, const Label& label, hid_t memory, std::size_t rows, std::size_t columns) {
    if (memory < 0) return leave(label.name, label.kind, "holds no numbers; name another");
    std::vector<double> values(rows * columns);
    if (!values.empty() && h5_.read(set, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
      return leave(label.name, label.kind,
                   "cannot be read: damaged, or packed by a filter other than gzip; save it again");
    const auto add = [&](std::string name, std::string kind, std::vector<double> numbers, const std::string& unit) {
      if (!unit.empty()) kind += ", " + unit;
      log_.columns.push_back({std::move(name), std::move(kind), std::move(numbers), {}, 0.0, unit});
    };
    if (rows == 1 || columns == 1) return add(label.name, label.kind, std::move(values), unit_at(label.units, 0));
    const bool samples_run_down = rows >= columns;
    const std::size_t channels = samples_run_down ? columns : rows, samples = samples_run_down ? rows : columns;
    for (std::size_t c = 0; c < channels; ++c) {
      std::vector<double> channel(samples);
      for (std::size_t k = 0; k < samples; ++k)
        channel[k] = samples_run_down ? values[k * columns + c] : values[c * columns + k];
      add(fmt::format("{}({})", label.name, c + 1),
          fmt::format("{} of {}", samples_run_down ? "column" : "row", label.kind), std::move(channel),
          unit_at(label.units, c));
    }
  }

  void leave(const std::string& name, const std::string& kind, std::string_view why) {
    log_.columns.push_back({name, kind, {}, fmt::format("'{}' ({}) {}", name, kind, why)});
  }

  /// A single unit applies to all columns or fields; otherwise each has its own.
  static std::string unit_at(const std::vector<std::string>& units, std::size_t number) {
    if (units.size() == 1) return units.front();
    return number < units.size() ? units[number] : "";
  }

  bool lies_elsewhere(hid_t set) const {
    const Hdf5Object plan(h5_.plan_of(set), h5_.close_plan);
    return h5_.layout_of(plan) == H5D_VIRTUAL || h5_.outer_files(plan) > 0;
  }

  bool is_number(hid_t type) const {
    const H5T_class_t kind = h5_.class_of(type);
    return kind == H5T_INTEGER || kind == H5T_FLOAT;
  }

  std::string kind_name(hid_t type) const {
    const std::size_t bits = 8 * h5_.size_of(type);
    switch (h5_.class_of(type)) {
      case H5T_INTEGER:
        return fmt::format("integer of {} bits", bits);
      case H5T_FLOAT:
        return fmt::format("real of {} bits", bits);
      case H5T_STRING:
        return "text";
      default:
        return "of a class that holds no numbers";
    }
  }

  /// Attributes `dt` (s) and `rate` (Hz) of groups and data sets, converted to a line of a preamble that states a
  /// period.
  void take_period(hid_t object) {
    constexpr std::pair<const char*, std::string_view> kPeriods[] = {{"dt", "sampling period: {} s"},
                                                                     {"rate", "sampling rate: {} Hz"}};
    for (const auto& [name, line] : kPeriods) {
      if (h5_.has_attribute(object, name) <= 0) continue;
      const Hdf5Object attribute(h5_.open_attribute(object, name, H5P_DEFAULT), h5_.close_attribute);
      const Hdf5Object space(h5_.space_of_attribute(attribute), h5_.close_space);
      const Hdf5Object type(h5_.type_of_attribute(attribute), h5_.close_type);
      double value = 0.0;
      if (!is_number(type) || h5_.points_of(space) != 1 || h5_.read_attribute(attribute, *h5_.a_double, &value) < 0)
        continue;
      const std::string stated = fmt::format(fmt::runtime(line), value);
      if (log_.preamble.size() < kMostPreamble && std::ranges::find(log_.preamble, stated) == log_.preamble.end())
        log_.preamble.push_back(stated);
    }
  }

  /// The texts of an attribute; empty if there is no attribute of that name.
  std::vector<std::string> texts_of(hid_t object, const char* name) const {
    constexpr std::size_t kLongest = 64, kMost = 1000;
    if (h5_.has_attribute(object, name) <= 0) return {};
    const Hdf5Object attribute(h5_.open_attribute(object, name, H5P_DEFAULT), h5_.close_attribute);
    const Hdf5Object space(h5_.space_of_attribute(attribute), h5_.close_space);
    const Hdf5Object type(h5_.type_of_attribute(attribute), h5_.close_type);
    const hssize_t points = h5_.points_of(space);
    if (h5_.class_of(type) != H5T_STRING || points < 1 || points > static_cast<hssize_t>(kMost)) return {};
    const auto count = static_cast<std::size_t>(points);
    std::vector<std::string> texts;
    if (h5_.is_pointer_to_text(type) > 0) {
      std::vector<char*> pointers(count, nullptr);
      if (h5_.read_attribute(attribute, type, pointers.data()) < 0) return {};
      for (char* const text : pointers) {
        texts.push_back(text != nullptr ? std::string(text).substr(0, kLongest) : "");
        h5_.free_memory(text);
      }
      return texts;
    }
    const std::size_t size = h5_.size_of(type);
    if (size == 0 || size > kLongest) return {};
    std::string bytes(size * count, '\0');
    if (h5_.read_attribute(attribute, type, bytes.data()) < 0) return {};
    for (std::size_t k = 0; k < count; ++k) texts.emplace_back(bytes.substr(k * size, size).c_str());
    return texts;
  }

  static constexpr std::size_t kMostObjects = 20'000;

  const Hdf5Library& h5_;
  Log log_;
  std::string refusal_;
  std::size_t objects_ = 0;
  double announced_ = 0.0;  ///< count of numbers; a compressed file may announce more than fits into memory
};

}  // namespace

Log read_hdf5(const std::string& path) {
  hdf5_library();
  return read_confined(path, kHdf5.file, [](const std::string& file) { return Hdf5Reader(file).read(); });
}

}  // namespace host
