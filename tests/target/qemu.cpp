#include "tests/target/qemu.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <thread>

namespace target_test {

namespace {

using Clock = std::chrono::steady_clock;
constexpr const char* kEmulator = "qemu-system-arm";

}  // namespace

std::filesystem::path image(const std::string& name) {
  const std::filesystem::path path = std::filesystem::path(AXIS_FIRMWARE_IMAGES) / (name + ".elf");
  return std::filesystem::exists(path) ? path : std::filesystem::path{};
}

bool emulator_is_installed() {
  const char* path = std::getenv("PATH");
  std::string rest = path != nullptr ? path : "";
  while (!rest.empty()) {
    const std::size_t colon = rest.find(':');
    if (access((rest.substr(0, colon) + "/" + kEmulator).c_str(), X_OK) == 0) return true;
    rest = colon == std::string::npos ? "" : rest.substr(colon + 1);
  }
  return false;
}

std::string obstacle(const std::string& name) {
  if (!emulator_is_installed()) return "qemu-system-arm is not installed";
  if (image(name).empty()) return name + ".elf is not built: make firmware";
  return {};
}

Qemu::Qemu(const std::string& machine, const std::filesystem::path& image, const std::filesystem::path& folder,
           const std::vector<std::string>& options) {
  // Started at its entry, because an image need not lie where the machine looks for a vector table.
  const std::string program = "loader,cpu-num=0,file=" + std::filesystem::absolute(image).string();
  std::vector<std::string> words{kEmulator, "-M", machine, "-device", program, "-display", "none", "-monitor", "none"};
  words.insert(words.end(), options.begin(), options.end());
  std::array<int, 2> to_child{}, from_child{};
  if (pipe2(to_child.data(), O_CLOEXEC) != 0 || pipe2(from_child.data(), O_CLOEXEC) != 0)
    throw std::runtime_error("no pipe to the emulator");
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  child_ = fork();
  if (child_ == 0) {
    dup2(to_child[0], STDIN_FILENO);
    dup2(from_child[1], STDOUT_FILENO);
    if (chdir(folder.c_str()) == 0) execvp(arguments[0], arguments.data());
    _exit(127);
  }
  close(to_child[0]);
  close(from_child[1]);
  input_ = to_child[1];
  printed_ = from_child[0];
}

Qemu::~Qemu() {
  if (child_ > 0) {
    kill(child_, SIGKILL);
    waitpid(child_, nullptr, 0);
  }
  close(input_);
  close(printed_);
}

void Qemu::send(const std::string& text) const {
  if (write(input_, text.data(), text.size()) != static_cast<ssize_t>(text.size()))
    throw std::runtime_error("the emulator does not take input");
}

bool Qemu::read_more(std::chrono::milliseconds limit) {
  pollfd waiting{printed_, POLLIN, 0};
  if (poll(&waiting, 1, static_cast<int>(limit.count())) <= 0) return false;
  std::array<char, 4096> buffer{};
  const ssize_t size = read(printed_, buffer.data(), buffer.size());
  if (size <= 0) return false;
  output_.append(buffer.data(), static_cast<std::size_t>(size));
  return true;
}

std::string Qemu::read_until(const std::string& text, std::chrono::seconds limit) {
  const auto end = Clock::now() + limit;
  for (;;) {
    const std::size_t found = output_.find(text, consumed_);
    if (found != std::string::npos) {
      std::string result = output_.substr(consumed_, found + text.size() - consumed_);
      consumed_ = found + text.size();
      return result;
    }
    if (Clock::now() > end)
      throw std::runtime_error("no \"" + text + "\" from the emulator; it printed: " + output_.substr(consumed_));
    read_more(std::chrono::milliseconds(100));
  }
}

Qemu start_program(const std::filesystem::path& folder) {
  return Qemu("mps2-an386", image("emulated"), folder,
              {"-icount", "shift=5", "-serial", "stdio", "-semihosting-config", "enable=on,target=native"});
}

int Qemu::wait(std::chrono::seconds limit) {
  const auto end = Clock::now() + limit;
  int status = 0;
  while (waitpid(child_, &status, WNOHANG) == 0) {
    if (Clock::now() > end) return -1;
    if (!read_more(std::chrono::milliseconds(20))) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  while (read_more(std::chrono::milliseconds(0))) continue;
  child_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace target_test
