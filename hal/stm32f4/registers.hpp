// Registers of the STM32F405 that this project uses. Sections are those of the reference manual, RM0090.
#pragma once

#include <cstdint>

#include "hal/cortex_m/registers.hpp"

namespace hal::stm32f4 {

using cortex_m::at_address;
using cortex_m::Register;

/// Reset and clock control, section 7.3.
struct Rcc {
  Register CR, PLLCFGR, CFGR, CIR, AHB1RSTR, AHB2RSTR, AHB3RSTR;
  std::uint32_t reserved0;
  Register APB1RSTR, APB2RSTR;
  std::uint32_t reserved1[2];
  Register AHB1ENR, AHB2ENR, AHB3ENR;
  std::uint32_t reserved2;
  Register APB1ENR, APB2ENR;
  std::uint32_t reserved3[2];
  Register AHB1LPENR, AHB2LPENR, AHB3LPENR;
  std::uint32_t reserved4;
  Register APB1LPENR, APB2LPENR;
  std::uint32_t reserved5[2];
  Register BDCR, CSR;

  static constexpr std::uint32_t kHsiOn = 1u << 0, kHsiReady = 1u << 1, kHsiTrim = 0x1Fu << 3;  // CR, 7.3.1
  static constexpr std::uint32_t kHseOn = 1u << 16, kHseReady = 1u << 17;                       // CR
  static constexpr std::uint32_t kClockSecurity = 1u << 19;                                     // CR
  static constexpr std::uint32_t kPllOn = 1u << 24, kPllReady = 1u << 25;                       // CR
  static constexpr std::uint32_t kPllFromHse = 1u << 22;                                        // PLLCFGR, 7.3.2
  static constexpr std::uint32_t kSwitchToPll = 2u << 0, kSwitchedMask = 3u << 2, kSwitchedToPll = 2u << 2;  // CFGR
  static constexpr std::uint32_t kApb1By4 = 5u << 10, kApb2By2 = 4u << 13;  // CFGR, 7.3.3
  static constexpr std::uint32_t kGpioA = 1u << 0, kGpioB = 1u << 1, kGpioC = 1u << 2, kCcm = 1u << 20,
                                 kDma1 = 1u << 21, kDma2 = 1u << 22;  // AHB1ENR, 7.3.10
  static constexpr std::uint32_t kOtgFs = 1u << 7;                    // AHB2ENR, 7.3.11
  static constexpr std::uint32_t kTim2 = 1u << 0, kTim3 = 1u << 1, kTim4 = 1u << 2, kTim5 = 1u << 3, kTim13 = 1u << 7,
                                 kWindowWatchdog = 1u << 11, kPower = 1u << 28;                             // APB1ENR
  static constexpr std::uint32_t kUsart1 = 1u << 4, kAdc1 = 1u << 8, kSpi1 = 1u << 12, kSyscfg = 1u << 14;  // APB2ENR
  // AHB1RSTR to APB2RSTR, 7.3.5 to 7.3.9: every peripheral that a boot ROM or an earlier program may have used. The
  // bits of PWR (APB1) and SYSCFG (APB2) are left out: their settings do no harm.
  static constexpr std::uint32_t kAhb1Resets = 0x2260'11FFu, kAhb2Resets = 0x0000'00F1u, kApb1Resets = 0x26FE'C9FFu,
                                 kApb2Resets = 0x0007'1933u;
  static constexpr std::uint32_t kRemoveResetFlags = 1u << 24;  // CSR, 7.3.21
  static constexpr std::uint32_t kBrownOutReset = 1u << 25, kPinReset = 1u << 26, kPowerReset = 1u << 27,
                                 kSoftwareReset = 1u << 28, kWatchdogReset = 1u << 29, kWindowReset = 1u << 30,
                                 kLowPowerReset = 1u << 31;  // CSR
};
inline Rcc& rcc() { return at_address<Rcc>(0x40023800); }

/// Power control, section 5.4.
struct Power {
  Register CR, CSR;
  static constexpr std::uint32_t kScale1 = 1u << 14;                         // CR.VOS: full speed
  static constexpr std::uint32_t kDetector = 1u << 4, kDetect2V9 = 7u << 5;  // CR.PVDE and CR.PLS, 5.4.1
  static constexpr std::uint32_t kBelowThreshold = 1u << 2;                  // CSR.PVDO, 5.4.2
};
inline Power& power() { return at_address<Power>(0x40007000); }

/// Flash interface, section 3.9.
struct FlashInterface {
  Register ACR, KEYR, OPTKEYR, SR, CR, OPTCR;

  static constexpr std::uint32_t kFiveWaitStates = 5u, kPrefetch = 1u << 8, kInstructionCache = 1u << 9,
                                 kDataCache = 1u << 10;                   // ACR, 3.9.1; wait states: table 11
  static constexpr std::uint32_t kDataCacheReset = 1u << 12;              // ACR
  static constexpr std::uint32_t kKey1 = 0x45670123, kKey2 = 0xCDEF89AB;  // KEYR, 3.9.2
  static constexpr std::uint32_t kErrors = 0xF0u, kBusy = 1u << 16;       // SR, 3.9.4
  static constexpr std::uint32_t kProgram = 1u << 0, kSectorErase = 1u << 1, kStart = 1u << 16, kLock = 1u << 31,
                                 kWordParallelism = 2u << 8;                                 // CR, 3.9.5
  static constexpr std::uint32_t sector_field(std::uint32_t sector) { return sector << 3; }  // CR
  static constexpr std::uint32_t kBrownOutField = 3u << 2, kBrownOutLevel3 = 0u << 2, kBrownOutLevel2 = 1u << 2,
                                 kBrownOutLevel1 = 2u << 2, kBrownOutOff = 3u << 2;  // OPTCR.BOR_LEV, 3.9.6
};
inline FlashInterface& flash_interface() { return at_address<FlashInterface>(0x40023C00); }

/// General-purpose I/O, section 8.4.
struct Gpio {
  Register MODER, OTYPER, OSPEEDR, PUPDR, IDR, ODR, BSRR, LCKR, AFR[2];
};
inline Gpio& gpio_a() { return at_address<Gpio>(0x40020000); }
inline Gpio& gpio_b() { return at_address<Gpio>(0x40020400); }
inline Gpio& gpio_c() { return at_address<Gpio>(0x40020800); }

/// General-purpose timers TIM2 to TIM5, section 18.4.
struct Timer {
  Register CR1, CR2, SMCR, DIER, SR, EGR, CCMR1, CCMR2, CCER, CNT, PSC, ARR;
  std::uint32_t reserved0;
  Register CCR1, CCR2, CCR3, CCR4;

  static constexpr std::uint32_t kEnable = 1u << 0;                                           // CR1, 18.4.1
  static constexpr std::uint32_t kTriggerWhileEnabled = 1u << 4, kTriggerOnUpdate = 2u << 4;  // CR2.MMS, 18.4.2
  static constexpr std::uint32_t kEncoderBothEdges = 3u << 0, kStartOnTrigger = 6u << 0;   // SMCR.SMS, 18.4.3, 18.3.12
  static constexpr std::uint32_t kFromInput1 = 5u << 4;                                    // SMCR.TS: TI1FP1
  static constexpr std::uint32_t from_trigger(std::uint32_t input) { return input << 4; }  // likewise: ITR0 to ITR3
  static constexpr std::uint32_t kCompare1Request = 1u << 9, kCompare2Request = 1u << 10;  // DIER: DMA, 18.4.4
  static constexpr std::uint32_t kCapture3Flag = 1u << 3, kOvercapture3Flag = 1u << 11,
                                 kCapture4Flag = 1u << 4;  // SR, 18.4.5
  static constexpr std::uint32_t kUpdate = 1u << 0;        // EGR, 18.4.6
  /// Of a channel in CCMR, 18.4.7: CCxS its own pin, ICxF 8 equal samples at 84 MHz; or CCxS the internal trigger.
  static constexpr std::uint32_t kFilteredPin = 1u << 0 | 3u << 4, kInternalTrigger = 3u << 0;
  static constexpr std::uint32_t kInput1Falls = 1u << 1, kCapture3Enable = 1u << 8,
                                 kCapture4Enable = 1u << 12;  // CCER, 18.4.9
};
inline Timer& timer2() { return at_address<Timer>(0x40000000); }
inline Timer& timer3() { return at_address<Timer>(0x40000400); }
inline Timer& timer4() { return at_address<Timer>(0x40000800); }
inline Timer& timer5() { return at_address<Timer>(0x40000C00); }
inline Timer& timer13() { return at_address<Timer>(0x40001C00); }  // section 19.5: one channel, otherwise the same

/// Serial peripheral interface, section 28.5.
struct Spi {
  Register CR1, CR2, SR, DR;

  static constexpr std::uint32_t kClockPhase2 = 1u << 0, kMaster = 1u << 2, kBaudBy4 = 1u << 3, kBaudBy8 = 2u << 3,
                                 kEnable = 1u << 6, kSoftwareSelect = 3u << 8;                    // CR1, 28.5.1
  static constexpr std::uint32_t kReceived = 1u << 0, kTransmitEmpty = 1u << 1, kBusy = 1u << 7;  // SR, 28.5.3
};
inline Spi& spi1() { return at_address<Spi>(0x40013000); }

/// Analogue-to-digital converter, section 13.13.
struct Adc {
  Register SR, CR1, CR2, SMPR1, SMPR2, JOFR[4], HTR, LTR, SQR1, SQR2, SQR3, JSQR, JDR[4], DR;

  static constexpr std::uint32_t kOverrun = 1u << 5;                             // SR, 13.13.1
  static constexpr std::uint32_t kScan = 1u << 8, kOverrunInterrupt = 1u << 26;  // CR1, 13.13.2
  static constexpr std::uint32_t kOn = 1u << 0, kDma = 1u << 8, kDmaContinues = 1u << 9, kTriggerTimer3 = 8u << 24,
                                 kTriggerRising = 1u << 28;  // CR2, 13.13.3
};
inline Adc& adc1() { return at_address<Adc>(0x40012000); }
inline Register& adc_common_control() { return at_address<Register>(0x40012304); }  // 13.13.16
inline constexpr std::uint32_t kAdcClockBy4 = 1u << 16;

/// DMA controllers, section 10.5.
struct DmaStream {
  Register CR, NDTR, PAR, M0AR, M1AR, FCR;

  static constexpr std::uint32_t kEnable = 1u << 0, kInterruptOnComplete = 1u << 4, kCircular = 1u << 8,
                                 kMemoryIncrement = 1u << 10, kPeripheral16 = 1u << 11, kPeripheral32 = 2u << 11,
                                 kMemory16 = 1u << 13, kMemory32 = 2u << 13, kHighPriority = 2u << 16,
                                 kChannel5 = 5u << 25;  // CR, 10.5.5
};
struct Dma {
  Register LISR, HISR, LIFCR, HIFCR;
  DmaStream stream[8];

  static constexpr std::uint32_t kStream0Complete = 1u << 5, kStream0All = 0x3Du;  // LISR and LIFCR, 10.5.1
};
inline Dma& dma1() { return at_address<Dma>(0x40026000); }
inline Dma& dma2() { return at_address<Dma>(0x40026400); }

/// Serial port, section 30.6.
struct Usart {
  Register SR, DR, BRR, CR1, CR2, CR3;

  static constexpr std::uint32_t kReceived = 1u << 5, kTransmitEmpty = 1u << 7;                    // SR, 30.6.1
  static constexpr std::uint32_t kReceiver = 1u << 2, kTransmitter = 1u << 3, kEnable = 1u << 13;  // CR1, 30.6.4
};
inline Usart& usart1() { return at_address<Usart>(0x40011000); }

/// Independent watchdog, section 21.4.
struct IndependentWatchdog {
  Register KR, PR, RLR, SR;

  static constexpr std::uint32_t kFeed = 0xAAAA, kUnlock = 0x5555, kStart = 0xCCCC;  // KR, 21.4.1
};
inline IndependentWatchdog& independent_watchdog() { return at_address<IndependentWatchdog>(0x40003000); }

/// Window watchdog, section 22.6.
struct WindowWatchdog {
  Register CR, CFR, SR;

  static constexpr std::uint32_t kRun = 1u << 7, kMost = 0x7Fu, kLeast = 0x40u;  // CR, 22.6.1
  static constexpr std::uint32_t kBy8 = 3u << 7;                                 // CFR.WDGTB, 22.6.2
};
inline WindowWatchdog& window_watchdog() { return at_address<WindowWatchdog>(0x40002C00); }

/// Full-speed USB, section 34.16.2: the global registers that TinyUSB does not set.
struct OtgFsGlobal {
  std::uint32_t reserved0[14];
  Register GCCFG;

  static constexpr std::uint32_t kNoVbusSensing = 1u << 21;
};
inline OtgFsGlobal& otg_fs_global() { return at_address<OtgFsGlobal>(0x50000000); }

/// Unique device identifier, section 39.1: 96 bits, the least significant first.
struct UniqueIdentifier {
  std::uint32_t words[3];
};
inline const UniqueIdentifier& unique_identifier() { return at_address<const UniqueIdentifier>(0x1FFF7A10); }

/// Interrupt numbers, table 62.
inline constexpr std::uint32_t kAdcInterrupt = 18;
inline constexpr std::uint32_t kDma2Stream0Interrupt = 56;
inline constexpr std::uint32_t kOtgFsInterrupt = 67;
inline constexpr std::uint32_t kInterruptCount = 82;

}  // namespace hal::stm32f4
