// axistool cut: cuts out a part of a record. axistool shift: shifts a channel in time.
#include <fmt/format.h>

#include <memory>

#include "host/axistool/commands.hpp"
#include "host/axistool/json_output.hpp"
#include "host/read_file.hpp"
#include "host/record/edit_record.hpp"
#include "host/record/read_record.hpp"

namespace axistool {

namespace {

struct EditArguments {
  std::string record, output, json, channel;
  double from_s = -HUGE_VAL, to_s = HUGE_VAL, by_s = 0.0;
};

void tell(const EditArguments& arguments, const host::Record& edited) {
  host::write_record(edited, arguments.output);
  if (!arguments.json.empty())
    write_json({{"format", "axis-edit/1"},
                {"record", arguments.output},
                {"rows", edited.size()},
                {"from_s", edited.t_s.front()},
                {"to_s", edited.t_s.back()}},
               arguments.json);
  if (arguments.json != "-")
    fmt::print("{}: {} rows, {} s to {} s\n", arguments.output, edited.size(), edited.t_s.front(), edited.t_s.back());
}

CLI::App* add_edit(CLI::App& app, const char* name, const char* what, EditArguments& arguments) {
  CLI::App* command = app.add_subcommand(name, what);
  add_input(*command, "RECORD", arguments.record, "record (axis-record/1)")->required();
  add_output(*command, "-o,--output", arguments.output, "the record to write")->required();
  add_json_option(*command, arguments.json);
  return command;
}

}  // namespace

void add_cut(CLI::App& app) {
  auto arguments = std::make_shared<EditArguments>();
  CLI::App* command = add_edit(app, "cut", "cut a part out of a record", *arguments);
  command->add_option("--from", arguments->from_s, "first t_s to keep, s; default: the beginning");
  command->add_option("--to", arguments->to_s, "last t_s to keep, s; default: the end");
  command->footer(
      "Example:\n"
      "  axistool cut log.csv --from 2.5 --to 9 -o moving.csv\n"
      "Time stamps stay unchanged; the header states the cut range.");
  command->callback([arguments] {
    tell(*arguments, host::cut_record(host::read_file(arguments->record, host::kRecordSize), arguments->record,
                                      arguments->from_s, arguments->to_s));
  });
}

void add_shift(CLI::App& app) {
  auto arguments = std::make_shared<EditArguments>();
  CLI::App* command = add_edit(app, "shift", "shift one channel of a record in time", *arguments);
  command->add_option("--channel", arguments->channel, "channel's name in the record: w_rad_s, u_V, …")->required();
  command->add_option("--by", arguments->by_s, "seconds; positive: later, negative: earlier")->required();
  command->footer(
      "Example:\n"
      "  axistool shift log.csv --channel w_rad_s --by -0.014 -o aligned.csv\n"
      "Shift a channel that lags the others by 14 ms by -0.014. Rows at the ends without a value of this channel are "
      "cut.");
  command->callback([arguments] {
    tell(*arguments, host::shift_channel(host::read_record(arguments->record), arguments->channel, arguments->by_s));
  });
}

}  // namespace axistool
