// matio is loaded only when it is needed. If it is missing, a message says so.
#include "host/import/mat_library.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/exit_codes.hpp"

namespace {

using testing::AllOf;
using testing::HasSubstr;

void expect_refusal(const std::string& file, const std::string& reason) {
  try {
    host::load_mat_library({file, "libmatio"});
    ADD_FAILURE() << file << " was taken for matio";
  } catch (const host::Failure& failure) {
    EXPECT_EQ(failure.code, host::ExitCode::bad_input);
    EXPECT_THAT(failure.what(), AllOf(HasSubstr(file), HasSubstr(reason), HasSubstr("apt-get install")));
  }
}

TEST(MatLibrary, SaysWhatToInstallWhereItIsMissing) { expect_refusal("libmatio.so.0", "cannot be loaded"); }

TEST(MatLibrary, IsNoOtherLibrary) { expect_refusal("libm.so.6", "has no function Mat_"); }

}  // namespace
