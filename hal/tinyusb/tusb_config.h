// TinyUSB's settings; the name is TinyUSB's. The build gives CFG_TUSB_MCU.
#pragma once

#define CFG_TUSB_OS OPT_OS_NONE
#define CFG_TUSB_DEBUG 0
#define CFG_TUSB_RHPORT0_MODE (OPT_MODE_DEVICE | OPT_MODE_FULL_SPEED)

#define CFG_TUD_ENABLED 1
#define CFG_TUD_ENDPOINT0_SIZE 64
#if CFG_TUSB_MCU == OPT_MCU_NONE
#define TUP_DCD_ENDPOINT_MAX 4  // as the STM32F4's full-speed controller has
#endif

// Events that wait between the interrupt and hal::tinyusb::poll: both endpoints, the control pipe, the bus.
#define CFG_TUD_TASK_QUEUE_SZ 16

// hid_function.cpp replaces TinyUSB's own HID class.
#define CFG_TUD_HID 1
