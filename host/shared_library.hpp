// A library that is loaded at run time.
#pragma once

#include <dlfcn.h>

#include <string>

namespace host {

/// Stays loaded until the program ends.
class SharedLibrary {
 public:
  /// `file`: a name or a path for the dynamic linker.
  explicit SharedLibrary(const std::string& file) : handle_(dlopen(file.c_str(), RTLD_LAZY | RTLD_LOCAL)) {
    if (handle_ == nullptr) why_not_ = dlerror();
  }

  bool is_loaded() const { return handle_ != nullptr; }
  const std::string& why_not() const { return why_not_; }

  /// Sets `symbol` to the library's function or variable of this name, with the type from the library's header; false
  /// if the library has no such symbol.
  template <typename Symbol>
  bool find(Symbol*& symbol, const char* name) const {
    symbol = reinterpret_cast<Symbol*>(dlsym(handle_, name));
    return symbol != nullptr;
  }

 private:
  void* handle_;
  std::string why_not_;
};

}  // namespace host
