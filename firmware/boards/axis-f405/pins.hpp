// Pin assignment: the pin table of README.md in code.
#pragma once

#include "hal/stm32f4/pin.hpp"

namespace firmware::boards::pins {

using hal::stm32f4::gpio_a;
using hal::stm32f4::gpio_b;
using hal::stm32f4::gpio_c;
using hal::stm32f4::Pin;

inline Pin encoder_y_a() { return {gpio_a(), 0}; }
inline Pin encoder_y_b() { return {gpio_a(), 1}; }
inline Pin encoder_y_index() { return {gpio_a(), 2}; }
inline Pin encoder_x_a() { return {gpio_a(), 15}; }
inline Pin encoder_x_b() { return {gpio_b(), 3}; }
inline Pin encoder_x_index() { return {gpio_b(), 10}; }
inline Pin encoder_x_fault() { return {gpio_c(), 13}; }
inline Pin encoder_y_fault() { return {gpio_c(), 14}; }
inline Pin dac_select() { return {gpio_a(), 4}; }
inline Pin dac_clock() { return {gpio_a(), 5}; }
inline Pin dac_data_in() { return {gpio_a(), 6}; }
inline Pin dac_data_out() { return {gpio_a(), 7}; }
inline Pin dac_not_clear() { return {gpio_b(), 0}; }
inline Pin tachometer_x() { return {gpio_c(), 0}; }
inline Pin tachometer_y() { return {gpio_c(), 1}; }
inline Pin enable_x() { return {gpio_c(), 4}; }
inline Pin enable_y() { return {gpio_c(), 5}; }
inline Pin drive_fault_x() { return {gpio_c(), 6}; }
inline Pin drive_fault_y() { return {gpio_c(), 7}; }
inline Pin drive_ready_x() { return {gpio_c(), 2}; }
inline Pin drive_ready_y() { return {gpio_c(), 3}; }
inline Pin brake_x() { return {gpio_a(), 3}; }
inline Pin brake_y() { return {gpio_b(), 1}; }
inline Pin dynamic_brake_x() { return {gpio_b(), 5}; }
inline Pin dynamic_brake_y() { return {gpio_b(), 11}; }
inline Pin power_relay() { return {gpio_c(), 11}; }
inline Pin positive_end_x() { return {gpio_b(), 12}; }
inline Pin negative_end_x() { return {gpio_b(), 13}; }
inline Pin home_x() { return {gpio_b(), 14}; }
inline Pin positive_end_y() { return {gpio_b(), 15}; }
inline Pin negative_end_y() { return {gpio_c(), 8}; }
inline Pin home_y() { return {gpio_c(), 9}; }
inline Pin emergency_stop() { return {gpio_c(), 10}; }
inline Pin probe() { return {gpio_b(), 6}; }
inline Pin led_running() { return {gpio_b(), 8}; }
inline Pin led_fault() { return {gpio_b(), 9}; }
inline Pin charge_pump() { return {gpio_c(), 12}; }
inline Pin usb_supply() { return {gpio_a(), 8}; }
inline Pin usb_minus() { return {gpio_a(), 11}; }
inline Pin usb_plus() { return {gpio_a(), 12}; }
inline Pin serial_out() { return {gpio_a(), 9}; }
inline Pin serial_in() { return {gpio_a(), 10}; }

}  // namespace firmware::boards::pins
