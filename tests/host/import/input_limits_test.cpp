// Inputs that need more memory or time than any measurement are rejected, with the limit in the message.
#include "host/input_limits.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <matio.h>

#include <array>
#include <fstream>

#include "host/exit_codes.hpp"
#include "host/import/log_file.hpp"
#include "host/read_file.hpp"
#include "host/record/read_record.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

using testing::HasSubstr;

template <typename Read>
std::string refusal(const Read& read) {
  try {
    read();
  } catch (const host::Failure& failure) {
    EXPECT_EQ(failure.code, host::ExitCode::bad_input);
    return failure.what();
  }
  return "read";
}

TEST(InputLimits, EndAFileThatNeverEnds) {
  EXPECT_THAT(refusal([] { host::read_record("/dev/zero"); }), HasSubstr("a line is longer than 1 MiB"));
  EXPECT_THAT(refusal([] { host::read_file("/dev/zero"); }), HasSubstr("larger than 16 MiB"));
}

TEST(InputLimits, LetAFileOfTheirSizeThrough) {
  const TemporaryFolder folder;
  constexpr host::ByteLimit kSmall{"a test", host::kMebibyte, false};
  std::string text(host::kMebibyte, 'x');
  EXPECT_EQ(host::read_file(folder.write("full", text), kSmall).size(), text.size());
  text += 'x';
  EXPECT_THAT(refusal([&] { host::read_file(folder.write("over", text), kSmall); }), HasSubstr("larger than 1 MiB"));
}

TEST(InputLimits, HoldForNumbersOfANumpyArray) {
  std::string file("\x93NUMPY\x01\x00", 8);
  const std::string header = "{'descr': '<f8', 'fortran_order': False, 'shape': (99999999999, 3), }\n";
  file += static_cast<char>(header.size());
  file += '\0';
  file += header + std::string(24, '\0');
  EXPECT_THAT(refusal([&] { host::parse_npy(file, "a.npy"); }), HasSubstr("the most that a log may have"));
}

/// A compressed variable of a few kB may announce gigabytes. Here only its dimensions do, and nothing is unpacked.
TEST(InputLimits, HoldForWhatAMatlabFileUnpacksTo) {
  const TemporaryFolder folder;
  const std::string path = folder.path("a.mat");
  mat_t* const file = Mat_CreateVer(path.c_str(), nullptr, MAT_FT_MAT5);
  std::array<std::size_t, 2> size{8000, 8000};
  std::vector<std::int8_t> zeros(size[0] * size[1]);
  matvar_t* const variable = Mat_VarCreate("t", MAT_C_INT8, MAT_T_INT8, 2, size.data(), zeros.data(), 0);
  Mat_VarWrite(file, variable, MAT_COMPRESSION_ZLIB);
  Mat_VarFree(variable);
  Mat_Close(file);
  EXPECT_LT(host::read_file(path).size(), 2 * host::kMebibyte);
  EXPECT_THAT(refusal([&] { host::read_log(path); }), HasSubstr("unpacks to more than 50000000 numbers"));
}

}  // namespace
