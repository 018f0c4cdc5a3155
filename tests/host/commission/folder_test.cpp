#include "host/commission/folder.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/host/temporary_folder.hpp"

namespace {

/// Catches a command that ends with the page of the folder that its own is a copy of.
TEST(CommissionFolder, NamesNoPageBeforeItsOwnIsWritten) {
  const TemporaryFolder folder;
  const std::string first = folder.path("first"), copy = folder.path("copy");
  host::CommissionFolder(first).put("page", first + "/page.html");
  std::filesystem::copy(first, copy);
  host::CommissionFolder copied(copy);
  copied.begin_at(host::commission_step("improve"));
  EXPECT_TRUE(copied.document().at("page").is_null());
  EXPECT_TRUE(host::CommissionFolder(copy).document().at("page").is_null());
  EXPECT_EQ(host::CommissionFolder(first).document().at("page"), first + "/page.html");
}

}  // namespace
