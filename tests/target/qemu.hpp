// Starts the emulator as a child and talks to it. Tests are skipped if the emulator or the image is missing.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

namespace target_test {

/// images/NAME.elf of the firmware build; empty if it has not been built.
std::filesystem::path image(const std::string& name);
bool emulator_is_installed();

/// Why target tests cannot run here with the image `name`; empty if they can.
std::string obstacle(const std::string& name);

class Qemu {
 public:
  /// Starts `machine` with the image in `folder` as working directory. `options` are added to those that every run
  /// needs.
  Qemu(const std::string& machine, const std::filesystem::path& image, const std::filesystem::path& folder,
       const std::vector<std::string>& options);
  Qemu(const Qemu&) = delete;
  Qemu& operator=(const Qemu&) = delete;
  ~Qemu();

  void send(const std::string& text) const;

  /// Reads the emulator's standard output until `text` appears after what was read before; throws after `limit`, with
  /// the output so far. Returns everything read by this call.
  std::string read_until(const std::string& text, std::chrono::seconds limit = std::chrono::seconds(30));

  /// Waits for the end; the exit status, or -1 after `limit`. What was printed meanwhile is in output().
  int wait(std::chrono::seconds limit = std::chrono::seconds(60));

  const std::string& output() const { return output_; }

 private:
  bool read_more(std::chrono::milliseconds limit);

  int child_ = -1;
  int input_ = -1;
  int printed_ = -1;
  std::string output_;
  std::size_t consumed_ = 0;
};

/// The program on the emulated board; `folder`: where the board looks for its USB cable. Its clocks count instructions,
/// so that its watchdog does not reset it if the computer is busy.
Qemu start_program(const std::filesystem::path& folder = std::filesystem::temp_directory_path());

}  // namespace target_test
