#include "host/commission/folder.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "host/commission/folder_lock.hpp"
#include "host/exit_codes.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

/// Catches a command in a copied folder that names the page of the original folder at its end.
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

/// Two simultaneous commissionings would mix their records.
TEST(FolderLock, IsOneCommissioningsAtATime) {
  const TemporaryFolder folder;
  {
    const host::FolderLock first(folder.path("x"));
    EXPECT_THROW(host::FolderLock(folder.path("x")), host::Failure);
  }
  EXPECT_NO_THROW(host::FolderLock(folder.path("x")));
}

}  // namespace
