// The folder for sockets and parameters of simulated boards belongs to the user, without rights for others.
#include "host/own_folder.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>

#include "host/exit_codes.hpp"
#include "host/link/socket_link.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

constexpr const char* kVariable = "AXIS_TEST_FOLDER";

unsigned rights(const std::string& path) {
  struct stat found {};
  EXPECT_EQ(::stat(path.c_str(), &found), 0) << path;
  return found.st_mode & 0777U;
}

host::ExitCode refusal() {
  try {
    host::own_folder(kVariable, ".local/state/axis");
    return host::ExitCode::done;
  } catch (const host::Failure& failure) {
    return failure.code;
  }
}

TEST(OwnFolder, LiesBelowTheHomeForTheUserAlone) {
  const TemporaryFolder home;
  ::setenv("HOME", home.path("me").c_str(), 1);
  ::unsetenv(kVariable);
  const std::string folder = host::own_folder(kVariable, ".local/state/axis");
  EXPECT_EQ(folder, home.path("me/.local/state/axis"));
  EXPECT_EQ(rights(folder), 0700U);
}

TEST(OwnFolder, IsNoneThatOthersMayWrite) {
  const TemporaryFolder folder;
  ::setenv(kVariable, folder.path("").c_str(), 1);
  EXPECT_EQ(refusal(), host::ExitCode::done);
  ASSERT_EQ(::chmod(folder.path("").c_str(), 01777), 0);
  EXPECT_EQ(refusal(), host::ExitCode::permission);
  ASSERT_EQ(::chmod(folder.path("").c_str(), 0700), 0);
  ::setenv(kVariable, "/proc/1/no-such-folder", 1);
  EXPECT_EQ(refusal(), host::ExitCode::permission);
}

TEST(SocketOfABoard, IsTheUsersAloneWhateverTheUmask) {
  const TemporaryFolder folder;
  const mode_t usual = ::umask(0);
  const host::OwnedDescriptor listener = host::listen_at_socket(folder.path("s"));
  ::umask(usual);
  EXPECT_EQ(rights(folder.path("s")) & 0077U, 0U);
}

}  // namespace
