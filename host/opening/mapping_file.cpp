#include "host/opening/mapping_file.hpp"

#include <fmt/format.h>

#include "host/toml_fields.hpp"
#include "host/toml_text.hpp"

namespace host {

std::string format_mapping_file(const std::vector<MappedAxis>& axes) {
  std::string text =
      "# How the channels of a controller's log become the columns of a record: axistool open LOG --map THIS_FILE\n"
      "# Each line of [[axis]] has the form of --map; see axistool help import.\n"
      "format = \"axis-mapping/1\"\n";
  for (const MappedAxis& axis : axes) {
    text += "\n[[axis]]\n";
    if (!axis.name.empty()) text += fmt::format("name = {}\n", toml_string(axis.name));
    text += fmt::format("map = {}\n", toml_string(axis.map));
    if (axis.resample_s)
      text += fmt::format("resample_s = {:#}  # uneven rows are resampled with this period\n", *axis.resample_s);
    for (std::size_t k = 0; k < axis.unwrap.size(); ++k)
      text += fmt::format("{}{}{}", k == 0 ? "unwrap = [" : ", ", toml_string(axis.unwrap[k]),
                          k + 1 == axis.unwrap.size() ? "]  # range at which it wraps\n" : "");
  }
  return text;
}

std::vector<MappedAxis> parse_mapping_file(std::string_view text, std::string_view name) {
  const toml::table root = parse_toml(text, name);
  TomlFields file(root, std::string(name), "the file");
  if (file.text("format") != "axis-mapping/1") file.fail("format", "must be \"axis-mapping/1\"");
  std::vector<MappedAxis> axes;
  for (const toml::table* table : file.tables("axis")) {
    TomlFields fields(*table, std::string(name), "[[axis]]");
    MappedAxis axis;
    axis.name = fields.optional_text("name").value_or("");
    axis.map = fields.text("map");
    axis.resample_s = fields.optional_number("resample_s");
    if (axis.resample_s && !(*axis.resample_s > 0.0)) fields.fail("resample_s", "must be above 0");
    axis.unwrap = fields.texts("unwrap");
    fields.refuse_rest();
    axes.push_back(std::move(axis));
  }
  file.refuse_rest();
  if (axes.empty()) file.fail("axis", "needs at least one [[axis]]");
  return axes;
}

}  // namespace host
