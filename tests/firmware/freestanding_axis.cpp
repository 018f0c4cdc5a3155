// One axis in float, compiled as for the target; check_freestanding.sh examines the object.
#include "firmware/core/axis.hpp"

namespace firmware_test {

struct RegisterAxis {
  struct Registers {
    std::uint32_t encoder;
    std::int32_t tachometer;
    std::int32_t dac;
    bool enable;
  };
  volatile Registers& registers;

  struct Encoder {
    volatile Registers& registers;
    hal::EncoderReading read() { return {registers.encoder, true}; }
  } encoder_{registers};
  struct Tachometer {
    volatile Registers& registers;
    hal::TachometerReading read() { return {registers.tachometer, true}; }
  } tachometer_{registers};
  struct Dac {
    volatile Registers& registers;
    bool write(std::int32_t code) {
      registers.dac = code;
      return true;
    }
    bool is_healthy() const { return true; }
  } dac_{registers};
  struct Enable {
    volatile Registers& registers;
    void set(bool on) { registers.enable = on; }
    bool is_faulted() { return false; }
  } enable_{registers};

  Encoder& encoder() { return encoder_; }
  Tachometer& tachometer() { return tachometer_; }
  Dac& dac() { return dac_; }
  Enable& drive_enable() { return enable_; }
};

}  // namespace firmware_test

template class firmware::Axis<float, firmware_test::RegisterAxis>;
