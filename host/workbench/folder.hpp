// The folder that the workbench serves. It is the working directory, so that commands use the same names.
#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace host::workbench {

/// Subfolder for the results of the jobs and the page's selection.
inline constexpr const char* kOwnFolder = "workbench";

/// A name below the folder: no "..", no leading "/" or "-", nothing hidden, no control characters.
bool is_plain_name(std::string_view name);

struct FolderFile {
  std::string name;
  std::string kind;  ///< "model", "sheet" (a data sheet, without effects), "record", "response" (JSON of `axistool
                     ///< bode`), or "log" of a layout that `axistool open` reads
  std::size_t bytes = 0;
  std::string role = "";  ///< of a commissioning's record, "train", "judge" or "off": for what that run uses it
};

class Folder {
 public:
  Folder();

  const std::filesystem::path& root() const { return root_; }

  /// Models, records and logs, sorted; at most some thousand. Excludes files outside the folder and links to them.
  std::vector<FolderFile> files() const;

  /// Returns `name` if it is a file of the folder. Throws Failure: usage for an invalid name, permission if links lead
  /// out of the folder, bad_input if there is no such file.
  std::string existing(const std::string& name) const;

  /// An unused name: "x+cogging.toml", "x+cogging-2.toml", ...
  std::string free_name(const std::string& stem, const std::string& extension) const;

  /// Makes kOwnFolder and returns the name of a file in it. Throws Failure(permission) if links lead out of the folder.
  std::string own_file(const std::string& name) const;

 private:
  std::filesystem::path root_;
};

/// A file that is being uploaded to the folder. When complete, it gets its name, or a similar unused one.
class Upload {
 public:
  /// Throws Failure(usage) if the name contains a folder or its kind is not read here.
  Upload(const Folder& folder, const std::string& name);
  Upload(const Upload&) = delete;
  Upload& operator=(const Upload&) = delete;
  ~Upload();

  /// False if the file would exceed `kLogSize`, or if the disk is full.
  bool append(const char* data, std::size_t size);

  std::string finish();

 private:
  const Folder& folder_;
  std::string name_, partial_;
  std::ofstream file_;
  std::size_t bytes_ = 0;
};

}  // namespace host::workbench
