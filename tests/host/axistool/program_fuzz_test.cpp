// Runs every analysis command on mutated inputs: lines and fields of records and models, tags of MATLAB files. For any
// input, the program must end by itself with a documented exit code, without an "unexpected" error; its inputs must be
// unchanged and its outputs complete. AXIS_FUZZ_SECONDS sets the duration, AXIS_FUZZ_SEED the seed.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>

#include "host/exit_codes.hpp"
#include "host/model/model_file.hpp"
#include "host/read_file.hpp"
#include "host/record/read_record.hpp"
#include "tests/host/axistool/run_axistool.hpp"
#include "tests/host/skip_where_instrumented.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

namespace fs = std::filesystem;
using Lines = std::vector<std::string>;

/// Longer with sanitizers; without them only crashes are found.
#ifdef AXIS_INSTRUMENTED
constexpr double kSeconds = 60.0;
#else
constexpr double kSeconds = 10.0;
#endif

double number_from(const char* variable, double otherwise) {
  const char* text = std::getenv(variable);
  return text == nullptr ? otherwise : std::strtod(text, nullptr);
}

Lines printed_lines(const std::string& text) {
  Lines lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

std::string joined(const Lines& parts, char separator) {
  std::string text;
  for (const std::string& part : parts) text += part + separator;
  return text;
}

Lines fields_of(const std::string& line) {
  Lines fields(1);
  for (const char c : line)
    if (c == ',')
      fields.emplace_back();
    else
      fields.back() += c;
  return fields;
}

/// A record of an oscillating drive with encoder and tachometer.
std::string sample_record(std::mt19937& random) {
  std::string text = "# format: axis-record/1\n# drive: x\n# sample_period_s: 0.001\nt_s,u_V,x_mm,w_rad_s\n";
  std::normal_distribution<double> noise(0.0, 0.2);
  const int rows = 350 + static_cast<int>(random() % 700);
  for (int k = 0; k < rows; ++k) {
    const double t = 1e-3 * k, angle = 2.0 * std::numbers::pi * 2.0 * t;
    const double count = 0.00244140625;
    char line[120];
    std::snprintf(line, sizeof line, "%.3f,%.4f,%.6f,%.4f\n", t, 2.0 * std::sin(angle + 0.4),
                  count * std::round(2.5 * (1.0 - std::cos(angle)) / count), 20.0 * std::sin(angle) + noise(random));
    text += line;
  }
  return text;
}

/// An uncompressed MATLAB level 5 file: header, then one element for each variable (MAT-File Format, chapter 1).
std::string sample_mat() {
  std::string file(128, ' ');
  const std::string_view head = "MATLAB 5.0 MAT-file";
  std::copy(head.begin(), head.end(), file.begin());
  file[124] = 0, file[125] = 1, file[126] = 'I', file[127] = 'M';
  const auto put = [&file](std::uint32_t value) { file.append(reinterpret_cast<const char*>(&value), 4); };
  constexpr std::uint32_t kRows = 400;
  constexpr std::uint32_t kInt8 = 1, kInt32 = 5, kUint32 = 6, kDouble = 9, kMatrix = 14, kDoubleClass = 6;
  const char* const names[] = {"t", "u", "x"};
  for (std::uint32_t variable = 0; variable < 3; ++variable) {
    put(kMatrix), put(16 + 16 + 16 + 8 + 8 * kRows);
    put(kUint32), put(8), put(kDoubleClass), put(0);
    put(kInt32), put(8), put(kRows), put(1);
    put(kInt8), put(1), put(static_cast<std::uint32_t>(names[variable][0])), put(0);
    put(kDouble), put(8 * kRows);
    for (std::uint32_t k = 0; k < kRows; ++k) {
      const double t = 1e-3 * k, value = variable == 0 ? t : std::sin(12.0 * t + variable);
      file.append(reinterpret_cast<const char*>(&value), 8);
    }
  }
  return file;
}

class Mutator {
 public:
  explicit Mutator(std::mt19937& random) : random_(random) {}

  std::string record(const std::string& text) {
    Lines lines = printed_lines(text);
    constexpr std::size_t kNames = 3;
    for (std::size_t times = 1 + below(3); times > 0 && lines.size() > kNames + 2; --times) {
      const std::size_t row = kNames + 1 + below(lines.size() - kNames - 1);
      const std::size_t column = below(fields_of(lines[kNames]).size());
      switch (below(12)) {
        case 0:
          edit(lines[row], [&](Lines& fields) { fields[std::min(column, fields.size() - 1)] = special(); });
          break;
        case 1:  // a channel that is constant, scaled, or grows
          each(lines, kNames + 1, column, [v = special()](const std::string&) { return v; });
          break;
        case 2: {
          const double factor = std::pow(10.0, static_cast<double>(below(40)) - 20.0);
          each(lines, kNames + 1, column,
               [=](const std::string& field) { return std::to_string(factor * std::strtod(field.c_str(), nullptr)); });
          break;
        }
        case 3:
          for (std::size_t k = kNames; k < lines.size(); ++k)
            edit(lines[k], [&](Lines& fields) { fields.erase(fields.begin() + std::min(column, fields.size() - 1)); });
          break;
        case 4:
          for (std::size_t k = kNames; k < lines.size(); ++k)
            edit(lines[k], [&](Lines& fields) { fields.push_back(fields[std::min(column, fields.size() - 1)]); });
          break;
        case 5:
          lines.erase(lines.begin() + row, lines.begin() + row + std::min(1 + below(400), lines.size() - row));
          break;
        case 6:
          lines.insert(lines.begin() + row, lines[row]);
          break;
        case 7:
          lines.erase(lines.begin() + below(kNames + 1));
          break;
        case 8: {
          static const char* const names[] = {"i_A",         "v_m_s",  "v_mm_s", "x_m",
                                              "w_ref_rad_s", "temp_C", "t_s",    "x_ref_mm"};
          edit(lines[kNames], [&](Lines& fields) { fields[std::min(column, fields.size() - 1)] = names[below(8)]; });
          break;
        }
        case 9:
          std::swap(lines[row], lines[kNames + 1 + below(lines.size() - kNames - 1)]);
          break;
        case 10:
          lines[row].resize(below(lines[row].size() + 1));
          break;
        default:
          return bytes(joined(lines, '\n'));
      }
    }
    return joined(lines, '\n');
  }

  std::string toml(const std::string& text) {
    Lines lines = printed_lines(text);
    for (std::size_t times = 1 + below(3); times > 0 && !lines.empty(); --times) {
      std::string& line = lines[below(lines.size())];
      const std::size_t equals = line.find('=');
      switch (below(9)) {
        case 0:
        case 1:
        case 2:
          if (equals != std::string::npos) line = line.substr(0, equals + 1) + " " + special();
          break;
        case 3:
          line.clear();
          break;
        case 4:
          lines.insert(lines.begin() + below(lines.size()), std::string(line));
          break;
        case 5:
          if (equals != std::string::npos)
            line = line.substr(0, equals + 1) + " " + std::string(below(2000), '[') + std::string(below(2000), ']');
          break;
        case 6: {
          std::string deep;
          for (std::size_t k = below(30'000); k > 0; --k) deep += "a.";
          line.insert(0, deep);
          break;
        }
        case 7: {
          static const char* const more[] = {"cogging",    "backlash",          "input_delay",
                                             "compliance", "viscous_asymmetry", "nonsense"};
          lines.push_back("[[effect]]"), lines.push_back(std::string("kind = \"") + more[below(6)] + "\"");
          break;
        }
        default:
          return bytes(joined(lines, '\n'));
      }
    }
    return joined(lines, '\n');
  }

  /// Sizes, types and flags of a binary file: words of four bytes.
  std::string words(std::string file) {
    static constexpr std::uint32_t kWords[] = {0,  1,  2,          5,          6,          8,   9,
                                               14, 15, 0x7fffffff, 0xffffffff, 0x80000000, 400, 1u << 20};
    for (std::size_t times = 1 + below(4); times > 0; --times) {
      const std::size_t places = std::min<std::size_t>(file.size(), below(2) == 0 ? 300 : file.size()) / 4;
      const std::uint32_t word = kWords[below(std::size(kWords))];
      if (places > 0) std::memcpy(file.data() + 4 * below(places), &word, 4);
    }
    if (below(8) == 0) file.resize(below(file.size()));
    return file;
  }

  std::size_t below(std::size_t bound) { return bound == 0 ? 0 : random_() % bound; }

 private:
  std::string bytes(std::string text) {
    for (std::size_t times = 1 + below(5); times > 0 && !text.empty(); --times)
      text[below(text.size())] = static_cast<char>(below(256));
    if (below(3) == 0) text.resize(below(text.size() + 1));
    return text;
  }

  std::string special() {
    static const char* const values[] = {
        "nan",    "inf",    "-inf",  "0",   "-0.0",  "1e308", "-1e308", "1e100",
        "1e-300", "5e-324", "",      "1,5", "\"a\"", "true",  "1e999",  "999999999999999999999",
        "-1",     "1",      "0.001", "1e6", "-1e6",  "{}",    "[]",     "0x10",
        "3.0"};
    return values[below(std::size(values))];
  }

  template <typename Edit>
  static void edit(std::string& line, const Edit& change) {
    Lines fields = fields_of(line);
    change(fields);
    line.clear();
    for (std::size_t k = 0; k < fields.size(); ++k) line += (k == 0 ? "" : ",") + fields[k];
  }

  template <typename Change>
  static void each(Lines& lines, std::size_t first, std::size_t column, const Change& change) {
    for (std::size_t k = first; k < lines.size(); ++k)
      edit(lines[k], [&](Lines& fields) {
        std::string& field = fields[std::min(column, fields.size() - 1)];
        field = change(field);
      });
  }

  std::mt19937& random_;
};

/// A command line and its weight; %m model, %r record, %f MATLAB file, %s scenario, %o a name for outputs.
struct Command {
  const char* line;
  unsigned weight;
};

constexpr Command kCommands[] = {
    {"compare %m %r --json %o.json --predictions %o.csv --report %o.html", 12},
    {"identify %r --drive %m -o %o.toml --json %o.json", 12},
    {"identify %r --drive %m --method unbiased-ls --deadband 0 -o %o.toml", 5},
    {"friction %r --model %m -o %o.toml --json %o.json", 6},
    {"friction %r --model %m --method paper -o %o.toml", 2},
    {"design %m -o %o.params --json %o.json", 8},
    {"import %r -o %o.csv", 6},
    {"import %r --resample 0.002 -o %o.csv", 4},
    {"import %f --map t_s=t,u_V=u,x_mm=x*10 -o %o.csv", 10},
    {"import %f --list", 3},
    {"hil %s --json %o.json", 4},
    {"diagnose %m --train %r --json %o.json", 1},
    {"add %m cogging --train %r -o %o.toml --json %o.json", 1},
};

class ProgramFuzz : public testing::Test {
 protected:
  /// Chooses a command at random, by weight.
  static std::string choose(Mutator& mutator) {
    unsigned sum = 0;
    for (const Command& command : kCommands) sum += command.weight;
    auto left = static_cast<unsigned>(mutator.below(sum));
    for (const Command& command : kCommands) {
      if (left < command.weight) return command.line;
      left -= command.weight;
    }
    return "";
  }

  std::string filled(std::string line) const {
    for (const auto& [mark, path] : std::map<std::string, std::string>{{"%m", folder.path("m.toml")},
                                                                       {"%r", folder.path("r.csv")},
                                                                       {"%f", folder.path("f.mat")},
                                                                       {"%s", folder.path("s.toml")},
                                                                       {"%o", folder.path("out")}})
      for (std::size_t at = 0; (at = line.find(mark)) != std::string::npos;) line.replace(at, 2, path);
    return line;
  }

  /// Fault in the way the program ended; empty if there is none.
  static std::string fault_of_end(const ProgramRun& run) {
    if (run.exit_code < 0) return "ended by a signal";
    if (run.exit_code == 124) return "";  // time limit of this test; run times are measured elsewhere
    if (run.exit_code > 9) return "undocumented exit code " + std::to_string(run.exit_code);
    for (const char* word : {"ERROR: AddressSanitizer", "runtime error:", "unexpected:", "terminate called"})
      if (run.output.find(word) != std::string::npos) return word;
    if (run.exit_code > 1 && run.output.empty()) return "no word of what is wrong";
    return "";
  }

  /// Existing outputs must be complete: each can be read in its format.
  std::string fault_of_outputs() const {
    for (const auto& entry : fs::directory_iterator(folder.path(""))) {
      const std::string name = entry.path().filename().string(), path = entry.path().string();
      if (name.find(".partial") != std::string::npos) return name;
      if (!name.starts_with("out")) continue;
      try {
        if (name.ends_with(".json") && nlohmann::json::parse(host::read_file(path)).empty()) return name;
        if (name.ends_with(".toml")) host::read_model(path, host::Bounds::examined_later);
        if (name.ends_with(".html") && !host::read_file(path).ends_with("</html>\n")) return name;
        if (name.ends_with(".csv") && !host::read_file(path).ends_with('\n')) return name;
      } catch (const std::exception& error) {
        return name + ": " + error.what();
      }
    }
    return "";
  }

  TemporaryFolder folder;
};

TEST_F(ProgramFuzz, NoInputBringsTheProgramDown) {
  const fs::path shipped = fs::path(AXIS_TEST_DATA) / "drive-cases" / "none" / "case-00" / "model.toml";
  const std::string model = host::read_file(shipped.string()), mat = sample_mat();
  const std::string scenario =
      "format = \"axis-scenario/1\"\nname = \"n\"\nduration_s = 0.5\n[x]\ndrive = \"paper x\"\n[y]\ndrive = \"paper "
      "y\"\n"
      "[[move]]\nat_s = 0.0\nkind = \"circle\"\nradius_mm = 5\nfeed_mm_s = 100.0\n[[move]]\nat_s = 0.3\nkind = "
      "\"jog\"\naxis = \"x\"\nspeed_mm_s = 20\n[[fault]]\nat_s = 0.2\nkind = \"blocked\"\naxis = \"y\"\n";
  const auto seed = static_cast<unsigned>(number_from("AXIS_FUZZ_SEED", 1));
  std::mt19937 random(seed);
  Mutator mutator(random);
  const auto end =
      std::chrono::steady_clock::now() + std::chrono::duration<double>(number_from("AXIS_FUZZ_SECONDS", kSeconds));
  std::map<int, unsigned> ends;
  unsigned runs = 0;
  for (; std::chrono::steady_clock::now() < end; ++runs) {
    const std::string record = sample_record(random);
    const bool bend_model = mutator.below(3) == 0;
    const std::map<std::string, std::string> inputs{{"m.toml", bend_model ? mutator.toml(model) : model},
                                                    {"r.csv", bend_model ? record : mutator.record(record)},
                                                    {"f.mat", mutator.words(mat)},
                                                    {"s.toml", mutator.toml(scenario)}};
    for (const auto& entry : fs::directory_iterator(folder.path(""))) fs::remove(entry.path());
    for (const auto& [name, text] : inputs) folder.write(name, text);
    const std::string line = filled(choose(mutator));
    const ProgramRun run = run_program(
        "ASAN_OPTIONS=exitcode=99:detect_leaks=0:allocator_may_return_null=1 UBSAN_OPTIONS=halt_on_error=1:exitcode=99 "
        "timeout 20 \"" +
        std::string(AXISTOOL_PROGRAM) + "\" " + line);
    ++ends[run.exit_code];
    std::string fault = fault_of_end(run);
    if (fault.empty()) fault = fault_of_outputs();
    for (const auto& [name, text] : inputs)
      if (host::read_file(folder.path(name)) != text) fault = name + " was changed";
    if (fault.empty()) continue;
    const fs::path kept =
        fs::temp_directory_path() / ("axis-fuzz-" + std::to_string(seed) + "-" + std::to_string(runs));
    fs::create_directories(kept);
    for (const auto& [name, text] : inputs)
      fs::copy_file(folder.path(name), kept / name, fs::copy_options::overwrite_existing);
    FAIL() << fault << "\nrun " << runs << " of seed " << seed << ": axistool " << line << "\ninputs kept in " << kept
           << "\n"
           << run.output;
  }
  std::printf("%u runs; exit codes:", runs);
  for (const auto& [code, count] : ends) std::printf(" %d: %u", code, count);
  std::printf("\n");
}

}  // namespace
