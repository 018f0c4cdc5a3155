// axistool man: the manual pages, for packages.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "host/atomic_file.hpp"
#include "host/axistool/command_options.hpp"
#include "host/axistool/commands.hpp"
#include "host/axistool/man_page.hpp"

namespace axistool {

void add_man(CLI::App& app) {
  auto folder = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("man", "write the manual pages, one per command, in troff");
  add_output(*command, "FOLDER", *folder, "folder for the pages", FileRole::output_folder)->required();
  command->footer("Example:\n  axistool man man1 && man man1/axistool-identify.1");
  command->callback([folder, &app] {
    const std::filesystem::path place(*folder);
    std::filesystem::create_directories(place);
    const auto write = [&](const std::string& name, const CLI::App& of) {
      host::write_file_atomically((place / (name + ".1")).string(), man_page(app, of));
    };
    write("axistool", app);
    for (const CLI::App* one : commands_of(app)) write("axistool-" + one->get_name(), *one);
  });
}

}  // namespace axistool
