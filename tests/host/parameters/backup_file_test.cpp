#include "host/parameters/backup_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/exit_codes.hpp"

namespace {

using testing::HasSubstr;

std::string message_of(std::string_view text) {
  try {
    host::parse_backup(text, "b.toml");
  } catch (const host::Failure& failure) {
    EXPECT_EQ(failure.code, host::ExitCode::bad_input);
    return failure.what();
  }
  return "restored";
}

firmware::ParameterValues some_values() {
  firmware::ParameterValues values;
  values.set(host::parse_assignment("x.feedback.k1=48.4").place, 48.4F);
  return values;
}

TEST(Backup, ReadsBackEveryBit) {
  const firmware::ParameterValues values = some_values();
  firmware::ParameterValues read;
  for (const host::Assignment& one : host::parse_backup(host::format_backup(values), "b.toml"))
    read.set(one.place, one.value);
  for (std::size_t place = 0; place < values.size(); ++place) EXPECT_EQ(read.at(place), values.at(place)) << place;
}

TEST(Backup, KeepsTablesOfPitchErrors) {
  const host::PitchTables tables{{}, {{-100, 5, -7}, {60000, 65536, 300}}};
  const std::string text = host::format_backup(some_values(), {{0x1234, 7}}, tables);
  EXPECT_EQ(message_of(text), "restored") << "it remains a file of parameters";
  EXPECT_EQ(host::pitch_of_backup(text, "b.toml", 2), tables);
  EXPECT_EQ(host::pitch_of_backup(host::format_backup(some_values()), "b.toml", 2), std::nullopt)
      << "an older backup contains no tables";
  const auto refusal = [&](std::string_view from, std::string_view to, std::size_t axes = 2) {
    std::string changed = text;
    changed.replace(changed.rfind(from), from.size(), to);
    try {
      host::pitch_of_backup(changed, "b.toml", axes);
    } catch (const host::Failure& failure) {
      return std::string(failure.what());
    }
    return std::string("taken");
  };
  EXPECT_THAT(refusal("60000", "-200"), HasSubstr("b.toml:")) << "in falling order";
  EXPECT_THAT(refusal("65536", "2000000000"), HasSubstr("not a valid point")) << "more than a board takes";
  for (const char* odd : {"sixty", "60000.5", "99999999999999999999", "inf", "60000 7", ""})
    EXPECT_THAT(refusal("60000", odd), HasSubstr("not a valid point")) << odd;
  EXPECT_THAT(refusal("60000", "60000", 1), HasSubstr("not a valid point")) << "a board with fewer axes";
}

TEST(Backup, CutAnywhereIsRefused) {
  const std::string whole = host::format_backup(some_values(), {{0x1234, 7}});
  for (std::size_t length = 0; length < whole.size(); length += 1)
    ASSERT_NE(message_of(std::string_view(whole).substr(0, length)), "restored") << length;
}

TEST(Backup, AChangedValueIsRefusedAndToldWhatTakesIt) {
  std::string text = host::format_backup(some_values());
  text.replace(text.find("48.4"), 4, "84.4");
  EXPECT_THAT(message_of(text), testing::AllOf(HasSubstr("CRC"), HasSubstr("set-params")));
}

TEST(Backup, AFileOfPartsIsNoBackup) {
  EXPECT_THAT(message_of("format = \"axis-params/1\"\n[x.feedback]\nk1 = 48.4\n"), HasSubstr("only 1 of the"));
}

TEST(Backup, EndsOfLinesMayBeAnotherSystems) {
  std::string text = host::format_backup(some_values());
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.insert(at, 1, '\r');
  EXPECT_EQ(message_of(text), "restored");
}

/// Older backups have no CRC: complete ones are accepted, truncated ones refused.
TEST(Backup, OfAnOlderProgramIsTakenWhole) {
  std::string whole = host::format_backup(some_values());
  whole.erase(whole.find("count ="), whole.find("\n[") - whole.find("count ="));
  EXPECT_EQ(message_of(whole), "restored");
  for (std::size_t length = 0; length < whole.size(); length += 37)
    ASSERT_NE(message_of(std::string_view(whole).substr(0, length)), "restored") << length;
  EXPECT_NE(message_of(std::string_view(whole).substr(0, whole.size() - 1)), "restored");
}

}  // namespace
