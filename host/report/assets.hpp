// Files that every report contains. The build embeds them in the program.
#pragma once

#include <string_view>

namespace host::assets {

std::string_view dygraphs_script();      ///< dygraphs, minified (Debian: libjs-dygraphs)
std::string_view synchronizer_script();  ///< its extra for common zoom and cursor of several charts
std::string_view dygraphs_style();
std::string_view heat_map_script();
std::string_view report_script();
std::string_view report_style();

}  // namespace host::assets
