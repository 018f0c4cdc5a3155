// MCAP files (mcap.dev/spec, version 0) as ROS 2 records them, read from start to end without their indices.
#include <fmt/format.h>
#include <lz4frame.h>
#include <zstd.h>

#include <map>
#include <span>

#include "firmware/app/crc32.hpp"
#include "host/exit_codes.hpp"
#include "host/import/joint_states.hpp"
#include "host/import/log_file.hpp"
#include "host/import/reader_library.hpp"
#include "host/input_limits.hpp"

namespace host {

namespace {

/// Unpacks `records` to `size` bytes; empty if they are damaged.
std::string unpack_zstd(std::string_view records, std::size_t size) {
  decltype(&ZSTD_decompress) decompress = nullptr;
  decltype(&ZSTD_isError) is_error = nullptr;
  const ReaderLibrary library("chunks packed by zstd", kZstd);
  library.find(decompress, "ZSTD_decompress");
  library.find(is_error, "ZSTD_isError");
  std::string text(size, '\0');
  const std::size_t got = decompress(text.data(), size, records.data(), records.size());
  return is_error(got) == 0 && got == size ? text : std::string();
}

std::string unpack_lz4(std::string_view records, std::size_t size) {
  decltype(&LZ4F_createDecompressionContext) create = nullptr;
  decltype(&LZ4F_freeDecompressionContext) release = nullptr;
  decltype(&LZ4F_decompress) decompress = nullptr;
  const ReaderLibrary library("chunks packed by lz4", kLz4);
  library.find(create, "LZ4F_createDecompressionContext");
  library.find(release, "LZ4F_freeDecompressionContext");
  library.find(decompress, "LZ4F_decompress");
  std::string text(size, '\0');
  LZ4F_dctx* context = nullptr;
  create(&context, LZ4F_VERSION);
  if (context == nullptr) return {};
  std::size_t put = size, taken = records.size();
  const std::size_t more = decompress(context, text.data(), &put, records.data(), &taken, nullptr);
  release(context);
  return more == 0 && put == size ? text : std::string();
}

/// Little-endian numbers, and texts preceded by their length.
class McapFields {
 public:
  explicit McapFields(std::string_view bytes) : rest_(bytes) {}

  bool is_good() const { return is_good_; }
  std::string_view rest() const { return rest_; }

  std::uint64_t number(std::size_t size) {
    std::uint64_t value = 0;
    const std::string_view raw = take(size);
    for (std::size_t k = 0; k < raw.size(); ++k)
      value |= static_cast<std::uint64_t>(static_cast<unsigned char>(raw[k])) << (8 * k);
    return value;
  }

  std::string_view text() { return take(number(4)); }

  std::string_view take(std::uint64_t size) {
    is_good_ = is_good_ && size <= rest_.size();
    if (!is_good_) return {};
    const std::string_view part = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return part;
  }

 private:
  std::string_view rest_;
  bool is_good_ = true;
};

class McapReader {
 public:
  McapReader(std::string_view bytes, std::string_view path) : bytes_(bytes), path_(path), joints_(path) {}

  Log read() {
    bytes_.remove_prefix(kMcapMagic.size());
    if (!take_records(bytes_, false))
      fail("it ends before its data do: the recording was broken off; mend it with mcap recover");
    std::vector<BagTopic> topics;
    for (const auto& [id, topic] : topics_) topics.push_back(topic);
    return joints_.log(topics);
  }

 private:
  enum class Opcode : std::uint8_t { footer = 2, schema = 3, channel = 4, message = 5, chunk = 6, data_end = 15 };

  [[noreturn]] void fail(const std::string& what) const {
    throw Failure(ExitCode::bad_input, fmt::format("{}: {}", path_, what));
  }

  /// Reads records. Returns true after the final record, or at the end of a chunk.
  bool take_records(std::string_view bytes, bool in_chunk) {
    McapFields fields(bytes);
    while (!fields.rest().empty()) {
      const auto opcode = static_cast<Opcode>(fields.number(1));
      const std::string_view record = fields.take(fields.number(8));
      if (!fields.is_good()) return false;
      if (opcode == Opcode::data_end || opcode == Opcode::footer) return !in_chunk;
      take_record(opcode, McapFields(record), in_chunk);
    }
    return in_chunk;
  }

  void take_record(Opcode opcode, McapFields record, bool in_chunk) {
    switch (opcode) {
      case Opcode::schema: {
        const std::uint64_t id = record.number(2);
        const std::string_view name = record.text();
        if (record.is_good()) schemas_[id] = name;
        break;
      }
      case Opcode::channel: {
        const std::uint64_t id = record.number(2), schema = record.number(2);
        const std::string topic(record.text()), encoding(record.text());
        const auto type = schemas_.find(schema);
        if (record.is_good()) topics_[id] = {topic, type == schemas_.end() ? "no type" : type->second, encoding};
        break;
      }
      case Opcode::message: {
        const auto topic = topics_.find(record.number(2));
        record.number(4);  // sequence number
        const auto logged_ns = static_cast<std::int64_t>(record.number(8));
        record.number(8);  // time of publication
        if (record.is_good() && topic != topics_.end() && topic->second.has_joint_states())
          joints_.add(topic->second.name, record.rest(), logged_ns);
        break;
      }
      case Opcode::chunk:
        if (in_chunk) fail("a chunk within a chunk: damaged; mend it with mcap recover");
        take_chunk(record);
        return;
      default:  // indices, statistics, attachments, and additions of later versions
        return;
    }
    if (!record.is_good()) fail("a record is shorter than its fields: damaged; mend it with mcap recover");
  }

  void take_chunk(McapFields chunk) {
    chunk.take(16);  // first and last time
    const std::uint64_t size = chunk.number(8), crc = chunk.number(4);
    const std::string_view packing = chunk.text(), records = chunk.take(chunk.number(8));
    if (!chunk.is_good()) fail("a chunk ends before its records: damaged; mend it with mcap recover");
    unpacked_ += packing.empty() ? 0 : size;
    if (size > kLargestChunk || unpacked_ > kLogSize.bytes)
      fail(fmt::format(
          "unpacks to more than {} MiB, the most that {} may have (a chunk: {} MiB); cut it with mcap filter",
          kLogSize.bytes / kMebibyte, kLogSize.of, kLargestChunk / kMebibyte));
    std::string unpacked;
    if (packing == "zstd")
      unpacked = unpack_zstd(records, size);
    else if (packing == "lz4")
      unpacked = unpack_lz4(records, size);
    else if (!packing.empty())
      fail(
          fmt::format("its chunks are packed by '{}', which is not read; pack them anew: mcap compress --compression "
                      "zstd",
                      packing.substr(0, 32)));
    const std::string_view plain = packing.empty() ? records : unpacked;
    if (plain.size() != size || (crc != 0 && firmware::crc32(std::as_bytes(std::span(plain))) != crc) ||
        !take_records(plain, true))
      fail("a chunk does not hold what its header says: damaged; mend it with mcap recover");
  }

  static constexpr std::size_t kLargestChunk = 256 * kMebibyte;

  std::string_view bytes_, path_;
  std::map<std::uint64_t, std::string> schemas_;
  std::map<std::uint64_t, BagTopic> topics_;
  JointStates joints_;
  std::size_t unpacked_ = 0;
};

}  // namespace

Log parse_mcap(std::string_view bytes, std::string_view path) { return McapReader(bytes, path).read(); }

}  // namespace host
