// Splits a name into words in small letters: at signs, at changes from small to large letters, and between letters and
// digits.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace host {

/// "X1_ActualPosition" -> x, 1, actual, position; "Istposition Achse 2" -> istposition, achse, 2; "DCBusVoltage" -> dc,
/// bus, voltage. Letters of other alphabets stay together.
std::vector<std::string> words_of(std::string_view name);

/// Small letters, also of Latin-1 and Cyrillic.
std::string in_small_letters(std::string_view text);

}  // namespace host
