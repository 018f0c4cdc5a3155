// The board of `axistool serve --device`.
#pragma once

#include <string>

namespace host::workbench {

struct LiveDevice {
  std::string device;  ///< as for open_device(); empty: none
  double patience_s = 1.0;
};

}  // namespace host::workbench
