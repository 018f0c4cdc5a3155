// Reading in a separate process: in every case the caller gets a log or an error message.
#include "host/import/confined_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <fstream>
#include <thread>
#include <vector>

#include "host/exit_codes.hpp"
#include "tests/host/skip_where_instrumented.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

using testing::HasSubstr;

host::Log sample(const std::string& path) {
  host::Log log;
  log.path = path;
  log.layout = "made";
  log.header["key"] = "value";
  log.preamble = {"line"};
  log.columns.push_back({"x", "kind", {1.0, -2.5}, "fault", 0.0, "mm", "t"});
  log.columns.push_back({"", "", std::vector<double>(300'000, 4.0), ""});  // more than a pipe holds
  return log;
}

std::string refusal_of(host::Log (*read)(const std::string&), const std::string& path = "file") {
  try {
    host::read_confined(path, "library", read);
  } catch (const host::Failure& failure) {
    EXPECT_EQ(failure.code, host::ExitCode::bad_input);
    return failure.what();
  }
  return "read";
}

TEST(ConfinedReader, ReturnsAllOfTheLog) {
  const host::Log log = host::read_confined("file", "library", sample), wanted = sample("file");
  EXPECT_EQ(log.path, wanted.path);
  EXPECT_EQ(log.layout, wanted.layout);
  EXPECT_EQ(log.header, wanted.header);
  EXPECT_EQ(log.preamble, wanted.preamble);
  ASSERT_EQ(log.columns.size(), wanted.columns.size());
  for (std::size_t k = 0; k < log.columns.size(); ++k) {
    EXPECT_EQ(log.columns[k].name, wanted.columns[k].name);
    EXPECT_EQ(log.columns[k].kind, wanted.columns[k].kind);
    EXPECT_EQ(log.columns[k].values, wanted.columns[k].values);
    EXPECT_EQ(log.columns[k].fault, wanted.columns[k].fault);
    EXPECT_EQ(log.columns[k].unit, wanted.columns[k].unit);
    EXPECT_EQ(log.columns[k].time, wanted.columns[k].time);
  }
}

TEST(ConfinedReader, TellsTheReadersRefusal) {
  EXPECT_EQ(refusal_of([](const std::string& path) -> host::Log {
              throw host::Failure(host::ExitCode::bad_input, path + ": no log");
            }),
            "file: no log");
}

TEST(ConfinedReader, SurvivesACrash) {
  EXPECT_THAT(refusal_of([](const std::string&) -> host::Log {
                raise(SIGSEGV);
                _exit(0);
              }),
              HasSubstr("library fails on it"));
  EXPECT_THAT(refusal_of([](const std::string&) -> host::Log { _exit(0); }), HasSubstr("library fails on it"));
}

TEST(ConfinedReader, EndsWhatDoesNotEnd) {
  EXPECT_THAT(refusal_of([](const std::string&) -> host::Log {
                for (volatile int k = 0;;) k = 1 - k;
              }),
              HasSubstr("longer than 5 s"));
}

TEST(ConfinedReader, WritesNoFile) {
  const TemporaryFolder folder;
  const std::string path = folder.write("log", "as it was");
  EXPECT_THAT(refusal_of(
                  [](const std::string& file) -> host::Log {
                    std::ofstream(file, std::ios::app) << "more";
                    return sample(file);
                  },
                  path),
              HasSubstr("library fails on it"));
  std::string text;
  std::getline(std::ifstream(path), text);
  EXPECT_EQ(text, "as it was");
}

TEST(ConfinedReader, HasNoMoreMemoryThanAGigabyte) {
  if (kInstrumented) GTEST_SKIP() << "sanitizers have taken all addresses before";
  EXPECT_THAT(refusal_of([](const std::string& path) {
                host::Log log = sample(path);
                log.columns[0].values.resize(std::size_t{150} << 20U, 1.0);
                return log;
              }),
              HasSubstr("more than 1024 MiB"));
}

/// As the server of the workbench and the Python module call it.
TEST(ConfinedReader, ReadsForSeveralThreadsAtOnce) {
  if (kInstrumented) GTEST_SKIP() << "the sanitizer's allocator keeps the locks of other threads in a forked child";
  std::atomic<bool> over = false;
  std::thread busy([&] {
    while (!over) std::vector<std::string>(100, std::string(1000, 'x')).clear();  // holds the locks of the heap
  });
  std::vector<std::thread> readers;
  std::atomic<int> read = 0, refused = 0;
  for (int k = 0; k < 4; ++k)
    readers.emplace_back([&, k] {
      for (int turn = 0; turn < 25; ++turn)
        if ((k + turn) % 2 == 0)
          read += host::read_confined("file", "library", sample).columns.size() == 2 ? 1 : 0;
        else
          refused += refusal_of([](const std::string&) -> host::Log { _exit(1); }) != "read" ? 1 : 0;
    });
  for (std::thread& reader : readers) reader.join();
  over = true;
  busy.join();
  EXPECT_EQ(read, 50);
  EXPECT_EQ(refused, 50);
}

}  // namespace
