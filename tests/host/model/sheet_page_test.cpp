// The page on the data sheet's format must be the one in the repository and agree with the reader.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>

#include "host/exit_codes.hpp"
#include "host/model/data_sheet_fields.hpp"
#include "host/model/model_file.hpp"
#include "host/model/sheet_text.hpp"
#include "host/read_file.hpp"

namespace {

std::vector<std::string> examples() {
  std::vector<std::string> found;
  const std::string page = host::sheet_page();
  for (std::size_t at = 0; (at = page.find("```toml\n", at)) != std::string::npos;) {
    const std::size_t end = page.find("```\n", at + 8);
    found.push_back(page.substr(at + 8, end - at - 8));
    at = end;
  }
  return found;
}

TEST(SheetPage, IsTheOneInTheRepository) {
  EXPECT_EQ(host::read_file(AXIS_TEST_DATA "/../../host/model/README.md"), host::sheet_page())
      << "write it anew: make pages";
}

// Catches a field that the reader requires but one of the four examples lacks.
TEST(SheetPage, ExamplesAreReadAndLackNothingThatIsNeeded) {
  ASSERT_EQ(examples().size(), 4U);
  for (const std::string& example : examples()) {
    const sim::DriveDescription drive = host::parse_drive(example, "example");
    for (const host::DataSheetField& field : host::kDataSheetFields) {
      const std::string without =
          std::regex_replace(example, std::regex("\n" + std::string(field.key) + " = [^\n]*"), "");
      if (!field.belongs_to(drive.data.kind) || without == example) continue;
      if (field.presence != host::Presence::required) continue;
      EXPECT_THROW((void)host::parse_drive(without, "example"), host::Failure) << field.key << "\n" << example;
    }
  }
}

// Catches lines that tell the user to fill in a field that its own table does not have.
TEST(SheetText, EveryLineExplainsItsField) {
  for (const sim::DriveKind kind : {sim::DriveKind::rotary, sim::DriveKind::linear}) {
    for (const bool by_current : {true, false}) {
      const std::string text = host::sheet_text({.name = "x", .kind = kind, .by_current = by_current});
      for (const host::DataSheetField& field : host::kDataSheetFields) {
        if (field.presence != host::Presence::required || !field.belongs_to(kind)) continue;
        EXPECT_THAT(text, testing::HasSubstr("# " + std::string(field.key) + " =")) << text;
        EXPECT_THAT(text, testing::HasSubstr(std::string(field.meaning))) << text;
      }
    }
  }
}

}  // namespace
