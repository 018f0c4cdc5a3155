// The D/A converter AD5752 with BIN/2sCOMP and LDAC tied low, behind its serial lines. Datasheet of AD5722, AD5732,
// AD5752: timing characteristics (t1 to t17), theory of operation, tables 15 to 24.
#pragma once

#include <array>
#include <optional>

#include "tests/hal/parts/spi_part.hpp"

namespace parts {

class ConverterPart : public SerialSlave {
 public:
  explicit ConverterPart(Bus& bus) : bus_(bus) { power_up(); }

  void data_line(bool level, double at_ns) override;
  void clock_line(bool level, double at_ns) override;
  bool answer_line(double at_ns) override;
  void select_line(bool level);
  void clear_line(bool level);  ///< CLR, active low

  /// Volts at the terminal of channel 0 (A) or 1 (B); empty while the channel is not powered.
  std::optional<double> output_V(unsigned channel) const;

  void power_up();                                                ///< also the state after a brown-out of its supply
  void heat();                                                    ///< above 150 degrees (thermal shutdown)
  void cool() { hot_ = false; }                                   ///< the alert stays until it is read
  void short_out(unsigned channel);                               ///< an output must supply more than 20 mA
  bool answers = true;                                            ///< false: absent, its line back stays low
  void deaf_for_answers(int frames) { silent_frames_ = frames; }  ///< this many answers to readings are disturbed

 private:
  void take(std::uint32_t word);
  std::uint32_t read_back(std::uint32_t word) const;

  Bus& bus_;
  std::array<std::uint32_t, 2> code_{}, range_{};
  std::array<double, 2> powered_at_ns_{};
  std::uint32_t control_ = 0, power_ = 0, alerts_ = 0;
  bool hot_ = false, cleared_ = false, selected_ = false;

  std::uint32_t shift_ = 0, answer_ = 0, leaving_ = 0;
  int falls_ = 0;
  int silent_frames_ = 0;
  bool answer_is_reading_ = false;
  bool data_ = false, clock_ = false, reading_ = false;
  bool line_ = false, line_before_ = false;
  double rose_at_ns_ = -1e9, fell_at_ns_ = -1e9, data_at_ns_ = -1e9, released_at_ns_ = -1e9;
};

}  // namespace parts
