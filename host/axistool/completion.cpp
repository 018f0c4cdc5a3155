#include "host/axistool/completion.hpp"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>

#include "host/axistool/commands.hpp"
#include "host/exit_codes.hpp"
#include "host/link/socket_link.hpp"
#include "host/link/usb_boards.hpp"
#include "host/parameters/parameter_names.hpp"
#include "host/shipped_files.hpp"
#include "sim/catalogue.hpp"

namespace axistool {

namespace {

using Words = std::vector<std::string>;

/// Text up to the first line feed, because shells show one line.
std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

void add_effects_to(Completions& all) {
  for (const sim::EffectInfo* info : sim::catalogue())
    all.words.push_back({std::string(info->kind), std::string(info->title)});
}

/// With "=" after it if a value follows; groups if none follows.
void add_parameters_to(Completions& all, bool with_value) {
  std::set<std::string> groups;
  for (const std::string& name : host::all_parameter_names()) {
    all.words.push_back({with_value ? name + "=" : name, std::string(host::info_at(host::require_place(name)).doc)});
    for (std::size_t dot = name.find('.'); dot != std::string::npos && !with_value; dot = name.find('.', dot + 1))
      groups.insert(name.substr(0, dot));
  }
  for (const std::string& group : groups) all.words.push_back({group, "all of this group"});
}

void add_devices_to(Completions& all) {
  try {
    for (const host::UsbBoard& board : host::find_usb_boards())
      all.words.push_back({"usb:" + board.serial_number, board.product});
  } catch (const host::Failure&) {  // the library that finds boards is missing, so no board can be listed
  }
  try {
    if (std::filesystem::exists(host::default_socket_path())) all.words.push_back({"sim", "simulated board"});
  } catch (const std::exception&) {  // its folder does not exist, so there is no simulated board
  }
}

void add_scenarios_to(Completions& all) {
  for (const std::string& name : host::shipped_scenarios()) all.words.push_back({name, "shipped"});
  all.files = {"toml"};
}

/// Values of options and positionals with these names, in any command.
void add_values(const CLI::App& app, const CLI::App& command, const std::string& name, Completions& all) {
  const std::map<std::string, Words> files = {{"--model", {"toml"}},   {"--drive", {"toml"}},     {"--train", {"csv"}},
                                              {"--validate", {"csv"}}, {"MODEL", {"toml"}},       {"model", {"toml"}},
                                              {"RECORD", {"csv"}},     {"IMAGE", {"bin"}},        {"--x", {"toml"}},
                                              {"--y", {"toml"}},       {"--z", {"toml"}},         {"--a", {"toml"}},
                                              {"--report", {"html"}},  {"--predictions", {"csv"}}};
  const std::map<std::string, std::function<void()>> words = {
      {"KIND", [&] { add_effects_to(all); }},
      {"kind", [&] { add_effects_to(all); }},
      {"NAME", [&] { add_parameters_to(all, false); }},
      {"PART", [&] { add_parameters_to(all, false); }},
      {"FILE|NAME=VALUE",
       [&] {
         add_parameters_to(all, true);
         all.files = {"toml"};
       }},
      {"--device", [&] { add_devices_to(all); }},
      {"SCENARIO", [&] { add_scenarios_to(all); }},
      {"AXIS",
       [&] {
         all.words = {{"x", ""}, {"y", ""}};
       }},
      {"--axis",
       [&] {
         all.words = {{"x", ""}, {"y", ""}};
       }},
      {"SHELL",
       [&] {
         all.words = {{"bash", ""}, {"zsh", ""}, {"fish", ""}};
       }},
      {"COMMAND", [&] {
         for (const CLI::App* one : commands_of(app))
           all.words.push_back({one->get_name(), first_line(one->get_description())});
       }}};
  if (const auto known = words.find(name); known != words.end())
    known->second();
  else if (const auto ending = files.find(name); ending != files.end())
    all.files = ending->second;
  else
    all.files = {"*"};
  if (command.get_name() == "compare" && name == "RECORD") all.files.push_back("toml");
  if (name == "IMAGE") all.files.push_back("hex");
}

/// "TEXT:{unbiased-ls,ls}" -> the words between the braces; empty if the option has no such list.
Words listed_values(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t open = type.find(":{"), close = type.rfind('}');
  Words values;
  if (open == std::string::npos || close == std::string::npos) return values;
  for (const std::string& value : CLI::detail::split(type.substr(open + 2, close - open - 2), ','))
    values.push_back(value);
  return values;
}

bool takes_file(const CLI::Option& option) { return option.get_type_name().starts_with("TEXT"); }

void add_values_of(const CLI::App& app, const CLI::App& command, const CLI::Option& option, Completions& all) {
  if (const Words listed = listed_values(option); !listed.empty()) {
    for (const std::string& value : listed) all.words.push_back({value, ""});
    return;
  }
  if (option.get_positional() || takes_file(option))
    add_values(app, command, option.get_positional() ? option.get_name(true, false) : option.get_name(false, false),
               all);
}

void add_options_to(const CLI::App& command, Completions& all) {
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames())
      all.words.push_back({"--" + name, first_line(option->get_description())});
    for (const std::string& name : option->get_snames())
      all.words.push_back({"-" + name, first_line(option->get_description())});
  }
}

/// Place of the last word: the value of an option, or a positional with this index.
class Place {
 public:
  Place(const CLI::App& command, const Words& words) : command_(command) {
    for (std::size_t k = 1; k + 1 < words.size(); ++k) pass(words[k]);
  }

  /// The option or positional that takes the last word, if any.
  const CLI::Option* taker() const { return open_; }
  bool must_be_value() const { return open_ != nullptr && given_ < open_->get_items_expected_min(); }
  const CLI::Option* positional() const {
    std::size_t left = positionals_;
    const CLI::Option* last = nullptr;
    for (const CLI::Option* option : command_.get_options()) {
      if (!option->get_positional()) continue;
      last = option;
      const auto most = static_cast<std::size_t>(std::max(1, option->get_items_expected_max()));
      if (left < most) return option;
      left -= most;
    }
    return last != nullptr && last->get_items_expected_max() > 1 ? last : nullptr;
  }

 private:
  void pass(const std::string& word) {
    if (word.size() > 1 && word.front() == '-' && !std::isdigit(static_cast<unsigned char>(word[1]))) {
      const CLI::Option* option = command_.get_option_no_throw(word);
      open_ = option != nullptr && option->get_items_expected_max() > 0 ? option : nullptr;
      given_ = 0;
    } else if (open_ != nullptr && given_ < open_->get_items_expected_max()) {
      ++given_;
      if (given_ >= open_->get_items_expected_max()) open_ = nullptr;
    } else {
      ++positionals_;
    }
  }

  const CLI::App& command_;
  const CLI::Option* open_ = nullptr;
  int given_ = 0;
  std::size_t positionals_ = 0;
};

void keep_beginnings(Completions& all, const std::string& current) {
  std::erase_if(all.words, [&](const Completion& one) { return !one.word.starts_with(current); });
}

}  // namespace

Completions complete(const CLI::App& app, const std::vector<std::string>& words) {
  Completions all;
  const std::string current = words.empty() ? "" : words.back();
  if (words.size() < 2) {
    for (const CLI::App* command : commands_of(app))
      all.words.push_back({command->get_name(), first_line(command->get_description())});
    if (current.starts_with('-')) add_options_to(app, all);
    keep_beginnings(all, current);
    return all;
  }
  const auto commands = commands_of(app);
  const auto command = std::ranges::find(commands, words.front(), [](const CLI::App* one) { return one->get_name(); });
  if (command == commands.end()) return all;
  const Place place(**command, words);
  if (current.starts_with('-') && !place.must_be_value())
    add_options_to(**command, all);
  else if (place.taker() != nullptr)
    add_values_of(app, **command, *place.taker(), all);
  else if (const CLI::Option* positional = place.positional())
    add_values_of(app, **command, *positional, all);
  else
    add_options_to(**command, all);
  keep_beginnings(all, current);
  return all;
}

}  // namespace axistool
