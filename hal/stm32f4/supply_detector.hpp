// The chip's programmable voltage detector. RM0090, 5.2.2.
#pragma once

#include "hal/stm32f4/registers.hpp"
#include "hal/supply.hpp"

namespace hal::stm32f4 {

class SupplyDetector {
 public:
  explicit SupplyDetector(Power& power) : power_(power) {}
  /// 2.9 V, the highest threshold: the converter and the encoders' receivers need 3 V.
  void start() { power_.CR = power_.CR | Power::kDetector | Power::kDetect2V9; }
  bool is_low() { return (power_.CSR & Power::kBelowThreshold) != 0; }

 private:
  Power& power_;
};
static_assert(Supply<SupplyDetector>);

}  // namespace hal::stm32f4
