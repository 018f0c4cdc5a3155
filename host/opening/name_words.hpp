// Splits a name into words in lower case: at signs, at changes from lower to upper case, and between letters and
// digits.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace host {

/// "X1_ActualPosition" -> x, 1, actual, position; "Istposition Achse 2" -> istposition, achse, 2; "DCBusVoltage" -> dc,
/// bus, voltage. Letters of other alphabets stay together.
std::vector<std::string> words_of(std::string_view name);

/// Lower case, also for Latin-1 and Cyrillic.
std::string in_small_letters(std::string_view text);

}  // namespace host
