// Both tachometers on ADC1, converted once a control period by a timer's trigger and brought to memory by DMA.
// RM0090, sections 13.3 to 13.8 and 10.3.
#pragma once

#include <array>

#include "hal/stm32f4/registers.hpp"
#include "hal/tachometer.hpp"

namespace hal::stm32f4 {

inline constexpr std::uint32_t kTachometerSamples = 4;  ///< per channel and period; their sum halves the noise

/// The conversions of one period, x y x y x y x y. Written by DMA.
using TachometerSamples = std::array<volatile std::uint16_t, 2 * kTachometerSamples>;

/// One tachometer: +-10 V scaled onto 0..3.3 V, so that 0 V reads as mid-scale. Codes are -8192..8188.
class TachometerChannel {
 public:
  TachometerChannel(const TachometerSamples& samples, std::uint32_t channel) : samples_(samples), channel_(channel) {}

  /// Called by the control interrupt, which the end of the DMA transfer starts, so the samples belong to this period.
  void conversions_have_arrived() { is_new_ = true; }

  TachometerReading read() {
    if (!is_new_) return {};
    is_new_ = false;
    std::int32_t sum = 0;
    for (std::uint32_t i = 0; i < kTachometerSamples; ++i) {
      const std::uint32_t sample = samples_[2 * i + channel_];
      if (sample <= kLeast || sample >= kMost) return {};  // a wire broken or shorted pins the input to a rail
      sum += static_cast<std::int32_t>(sample) - kMiddle;
    }
    return {.code = sum, .valid = true};
  }

 private:
  static constexpr std::int32_t kMiddle = 2048;
  static constexpr std::uint32_t kLeast = 8, kMost = 4087;  // within 0.2 % of a rail

  const TachometerSamples& samples_;
  std::uint32_t channel_;
  bool is_new_ = false;
};
static_assert(Tachometer<TachometerChannel>);

/// Channels 10 and 11 (PC0, PC1) in turn; TIM3's update starts each scan; the end of the transfer interrupts.
class TachometerScan {
 public:
  TachometerScan(Adc& adc, Register& common_control, Dma& dma, TachometerSamples& samples)
      : adc_(adc), common_control_(common_control), dma_(dma), samples_(samples) {}

  /// The converter needs 3 us from here to its first trigger (datasheet, table 67).
  void start() {
    begin_transfer();
    common_control_ = kAdcClockBy4;  // 21 MHz
    adc_.CR1 = Adc::kScan | Adc::kOverrunInterrupt;
    adc_.SMPR1 = 3u << 0 | 3u << 3;        // 56 cycles on both: a scan takes 8 * 68 / 21 MHz = 26 us
    adc_.SQR1 = (kConversions - 1) << 20;  // scan length (13.13.9)
    adc_.SQR3 = kPair | kPair << 10 | kPair << 20;
    adc_.SQR2 = kPair;
    adc_.CR2 = kOn;
  }

  /// In the control interrupt.
  void acknowledge() { dma_.LIFCR = Dma::kStream0All; }

  /// For the converter's interrupt: an overrun, because a conversion was not read in time. Restarts transfer and
  /// converter, since requests and triggers are ignored until then (13.8.1) and no further control interrupt would
  /// occur.
  void recover_from_overrun() {
    if ((adc_.SR & Adc::kOverrun) == 0) return;
    overruns_ = overruns_ + 1;
    adc_.CR2 = 0;
    begin_transfer();
    adc_.SR = ~Adc::kOverrun;
    adc_.CR2 = kOn;
  }
  std::uint32_t overruns() const { return overruns_; }

 private:
  static constexpr std::uint32_t kX = 10, kY = 11;
  static constexpr std::uint32_t kPair = kX | kY << 5;
  static constexpr std::uint32_t kConversions = 2 * kTachometerSamples;
  static constexpr std::uint32_t kOn =
      Adc::kOn | Adc::kDma | Adc::kDmaContinues | Adc::kTriggerTimer3 | Adc::kTriggerRising;

  /// DMA2 stream 0, channel 0: ADC1 (table 43). Off, flags cleared, set up, on (10.3.17).
  void begin_transfer() {
    DmaStream& stream = dma_.stream[0];
    stream.CR = stream.CR & ~DmaStream::kEnable;
    for (int poll = 0; poll < 1000 && (stream.CR & DmaStream::kEnable) != 0; ++poll) continue;
    dma_.LIFCR = Dma::kStream0All;
    stream.PAR = static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(&adc_.DR));
    stream.M0AR = static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(samples_.data()));
    stream.NDTR = kConversions;
    stream.CR = DmaStream::kCircular | DmaStream::kMemoryIncrement | DmaStream::kPeripheral16 | DmaStream::kMemory16 |
                DmaStream::kHighPriority | DmaStream::kInterruptOnComplete | DmaStream::kEnable;
  }

  Adc& adc_;
  Register& common_control_;
  Dma& dma_;
  TachometerSamples& samples_;
  volatile std::uint32_t overruns_ = 0;  // written in the interrupt, read in the background
};

}  // namespace hal::stm32f4
