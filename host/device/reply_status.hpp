// Error messages for a board's refusals.
#pragma once

#include <string>

#include "firmware/app/protocol/report.hpp"

namespace host {

/// Throws Failure with cause and remedy for a status other than ok; `others` may name other programs that have the
/// board open.
void require_ok(const firmware::Message& reply, const std::string& others = "");

}  // namespace host
