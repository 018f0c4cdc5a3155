// The files of the page, which are embedded in the program.
#pragma once

#include <string_view>
#include <vector>

namespace host::workbench {

struct PageFile {
  std::string_view name;  ///< "main.js"
  std::string_view type;  ///< "text/javascript; charset=utf-8"
  std::string_view text;
};

/// All files; the first one is the page itself.
const std::vector<PageFile>& page_files();

}  // namespace host::workbench
