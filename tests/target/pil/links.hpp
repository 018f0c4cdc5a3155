// Links from this computer's plant to the emulated board.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "firmware/boards/pil/frame.hpp"
#include "tests/host/temporary_folder.hpp"
#include "tests/target/pil/scenario.hpp"
#include "tests/target/qemu.hpp"

namespace target_test {

/// A descriptor that closes itself. Reads and writes are complete or throw; reads wait at most 30 s.
class Stream {
 public:
  explicit Stream(int descriptor) : descriptor_(descriptor) {}
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;
  ~Stream();

  void write(std::span<const std::byte> bytes) const;
  void read(std::span<std::byte> bytes) const;

 private:
  int descriptor_;
};

/// Two FIFOs that the image reads and writes by semihosting, in its control interrupt.
class FileLink {
 public:
  explicit FileLink(const std::string& image_name);

  template <typename T>
  void send(const T& message) {
    requests_->write(std::as_bytes(std::span(&message, 1)));
  }
  template <typename T>
  T receive() {
    T message;
    replies_->read(std::as_writable_bytes(std::span(&message, 1)));
    return message;
  }
  int finish();

 private:
  TemporaryFolder folder_;
  std::unique_ptr<Stream> requests_, replies_;
  std::unique_ptr<Qemu> board_;
};

/// The image's USART on a socket, with framing and CRC.
class SerialLink {
 public:
  explicit SerialLink(const std::string& image_name);

  template <typename T>
  void send(const T& message) {
    std::vector<std::byte> bytes;
    firmware::boards::send_frame(std::as_bytes(std::span(&message, 1)), [&](std::byte byte) { bytes.push_back(byte); });
    socket_->write(bytes);
  }
  template <typename T>
  T receive() {
    T message;
    receive_frame();
    if (receiver_.payload().size() != sizeof message) throw std::runtime_error("a frame of another size");
    std::memcpy(static_cast<void*>(&message), receiver_.payload().data(), sizeof message);
    return message;
  }
  /// Sends bytes as they are, to disturb the line.
  void send_noise(std::span<const std::byte> bytes) { socket_->write(bytes); }
  int finish();

 private:
  void receive_frame();

  TemporaryFolder folder_;
  firmware::boards::FrameReceiver<512> receiver_;
  std::unique_ptr<Qemu> board_;
  std::unique_ptr<Stream> socket_;
};

/// The run of the scenario, or of its beginning, over a link.
template <typename Scalar, typename Link>
Replies run_over(Link& link, std::uint32_t periods = kPeriods, const Story& story = motion_story()) {
  using firmware::boards::PilConfigured;
  using firmware::boards::PilReply;
  using firmware::boards::PilRequest;
  link.send(BoardUnits<Scalar>::parameters());
  for (const std::uint32_t error : link.template receive<PilConfigured>().error)
    if (error != 0) throw std::runtime_error("the board refuses the parameters: error " + std::to_string(error));
  const auto exchange = [&link](const PilRequest& request) {
    link.send(request);
    return link.template receive<PilReply>();
  };
  return run<Scalar>(periods, exchange, story);
}

}  // namespace target_test
