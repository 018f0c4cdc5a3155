// axistool import: makes a record from a log.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "host/axistool/commands.hpp"
#include "host/axistool/json_output.hpp"
#include "host/import/import_record.hpp"
#include "host/record/columns.hpp"
#include "host/record/read_record.hpp"

namespace axistool {

namespace {

struct Options {
  std::string file, map, drive, output, json;
  std::vector<std::string> unwrap;
  double resample_s = 0.0;
  bool list = false;
};

constexpr const char* kFooter =
    "Columns of a record, with their units: t_s; u_V or i_A; x_mm or x_m; w_rad_s (rotary) or v_m_s, v_mm_s (linear);\n"
    "x2_mm, x2_m (the table, by a scale); x_ref_mm, x_ref_m, w_ref_rad_s, v_ref_m_s, temp_C. Other columns are kept\n"
    "and ignored.\n"
    "A mapping may scale and shift (t_s=t_ms*0.001, x_mm=counts*0.00122-5, x_m=-pos) and name a column by its number\n"
    "(x_mm=#3 or x_mm=3*0.5), one column of a matrix (x_m=log(2)), a field (x_m=run.pos), a data set with its\n"
    "groups (x_m=\"run/pos\"), a joint's quantity (x_m=joint1.position), separate time stamps\n"
    "(x_m=pos@t_pos, with --resample) or the row number (t_s=row*0.001). Quote names with spaces: u_V=\"Command "
    "(V)\".\n"
    "Examples:\n"
    "  axistool import data.mat --list\n"
    "  axistool import data.mat --map t_s=t,x_m=qm,u_V=vir -o record.csv\n"
    "  axistool import scope.csv --map t_s=1,u_V=2*10,x_mm=3*0.00122 --resample 0.001 --drive x -o record.csv\n"
    "  axistool import angle.csv --unwrap x_mm=6.2831853 -o turns.csv\n"
    "  axistool import jittered.csv --resample 0.001 -o even.csv        (a record keeps its column names)";

void list_contents(const host::Log& log) {
  for (std::size_t k = 0; k < log.columns.size(); ++k) {
    const host::LogColumn& column = log.columns[k];
    fmt::print("#{:<3} {:<24} {}", k + 1, column.name.empty() ? "(no heading)" : column.name, column.kind);
    if (!column.fault.empty()) fmt::print("; {}", column.fault);
    if (column.fault.empty() && !column.values.empty()) {
      const auto [low, high] = std::ranges::minmax(column.values);
      fmt::print(", {:.6g} to {:.6g}", low, high);
    }
    fmt::print("\n");
  }
}

nlohmann::json describe(const host::Record& record, const std::string& output) {
  nlohmann::json document = {{"format", "axis-import/1"},
                             {"record", output},
                             {"drive", record.drive},
                             {"rows", record.size()},
                             {"sample_period_s", record.sample_period_s},
                             {"channels", nlohmann::json::object()},
                             {"notes", nlohmann::json::object()}};
  for (const auto channel : host::kChannelsInFileOrder) {
    const std::vector<double>& values = record.*channel;
    if (values.empty()) continue;
    const auto [low, high] = std::ranges::minmax(values);
    document["channels"][std::string(host::column_name(channel, record.kind))] = {{"min", low}, {"max", high}};
  }
  for (const auto& [key, value] : record.header)
    if (key.starts_with("resampled") || key.starts_with("unwrapped")) document["notes"][key] = value;
  return document;
}

void print(const nlohmann::json& document) {
  fmt::print("{}: {} rows, every {} s\n", document["record"].get<std::string>(), document["rows"].get<std::size_t>(),
             document["sample_period_s"].get<double>());
  for (const auto& [name, range] : document["channels"].items())
    fmt::print("  {:<12} {:.6g} to {:.6g}\n", name, range["min"].get<double>(), range["max"].get<double>());
  for (const auto& [key, value] : document["notes"].items()) fmt::print("  {}: {}\n", key, value.get<std::string>());
}

void run(const Options& options) {
  const host::Log log = host::read_log(options.file);
  if (options.list) {
    list_contents(log);
    return;
  }
  host::ImportOptions import;
  if (!options.map.empty()) import.mappings = host::parse_mappings(options.map);
  if (options.resample_s > 0.0) import.resample_period_s = options.resample_s;
  import.drive = options.drive;
  for (const std::string& text : options.unwrap) import.unwrap.push_back(host::parse_unwrapping(text));
  const host::Record record = host::import_record(log, import);
  host::write_record(record, options.output);
  const nlohmann::json document = describe(record, options.output);
  if (!options.json.empty()) write_json(document, options.json);
  if (options.json != "-") print(document);
}

}  // namespace

void add_import(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("import", "Make a record from a MATLAB or HDF5 file, a ROS 2 bag or any table");
  const auto options = std::make_shared<Options>();
  add_input(*command, "file", options->file,
            "the log: .mat (v4, v5, v7.3), .h5, .npy, .npz, joint states in a ROS 2 bag (.mcap, .db3), or a table with "
            "commas, semicolons, tabs or spaces")
      ->required();
  command->add_option("--map", options->map, "column=variable[*factor][+shift], … (see below)");
  command
      ->add_option("--resample", options->resample_s,
                   "resample evenly with this period, s; the record states jitter, gaps and method")
      ->check(CLI::PositiveNumber);
  command
      ->add_option(
          "--unwrap", options->unwrap,
          "COLUMN=RANGE: the column wraps at RANGE (a counter that overflows, an angle within a turn); unwrap it")
      ->expected(1);
  command->add_option("--drive", options->drive, "name of the drive, for the record's header");
  CLI::Option* list = command->add_flag("--list", options->list, "list what the log holds, and write nothing");
  CLI::Option* output = add_output(*command, "-o,--output", options->output, "the record to write");
  output->excludes(list);
  add_json_option(*command, options->json);
  command->footer(kFooter);
  command->callback([options, output] {
    if (!options->list && output->empty()) throw CLI::RequiredError("-o");
    run(*options);
  });
}

}  // namespace axistool
