#include "host/record/log_fault.hpp"

namespace host {

namespace {

struct Row {
  std::string_view name, family, remedy;
};

/// In the order of LogFaultKind.
constexpr Row kRows[] = {
    {"integer_wrap", "jump", "take it out with axistool import --unwrap, and log with a wider counter"},
    {"new_zero", "jump", "cut the record there with axistool cut"},
    {"dropped_samples", "gap",
     "record again, cut the record there with axistool cut, or accept interpolation with axistool import --resample"},
    {"uneven_clock", "jitter", "import the sampler's own time stamps with axistool import --resample"},
    {"derived_channel", "duplicate", "log the tachometer, or leave the column out"},
    {"command_sign", "sign", "invert the sign of the command, or of position and speed, with axistool import --map"},
    {"command_scale", "unit", "scale the column with axistool import --map, or correct the gains in the data sheet"},
    {"position_scale", "unit", "scale the column with axistool import --map, or correct the lead in the data sheet"},
    {"time_shift", "time_shift", "shift the column with axistool shift RECORD --channel COLUMN --by SECONDS"},
    {"speed_sign", "sign", "invert the sign of the speed or of the position with axistool import --map"},
    {"table_sign", "sign", "invert the sign of the table's position with axistool import --map"},
    {"wrong_unit", "unit", "scale the column with axistool import --map"},
    {"dead_channel", "dead", "check wiring and assignment, or leave the column out"},
    {"copied_channel", "duplicate", "also log the other channel, or leave the copy out"},
    {"swapped", "swapped", "exchange the two columns' names"},
    {"clipped", "clipped", "log the command over its whole range, or record with smaller commands"},
    {"scaled_copy", "scaled_copy", "log the other channel itself, or leave the copy out"},
    {"another_zero", "zero", "home on the encoder's index before each record"},
    {"same_record", "same_record", "give a record of another motion"},
    {"records_disagree", "records_disagree",
     "record again under one set of units and settings, or leave the record out"},
    {"other_drive", "other_drive", "give the model of this drive, or a record of the model's drive"},
    {"no_encoder", "data_sheet", "add [drive.encoder] with its resolution to the data sheet"},
};

const Row& row_of(LogFaultKind kind) { return kRows[static_cast<std::size_t>(kind)]; }

}  // namespace

std::string_view log_fault_name(LogFaultKind kind) { return row_of(kind).name; }
std::string_view log_fault_family(LogFaultKind kind) { return row_of(kind).family; }
std::string_view log_fault_remedy(LogFaultKind kind) { return row_of(kind).remedy; }

}  // namespace host
