// A measurement: evenly sampled channels of one axis, as `axis-record/1` holds them.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim/drive_description.hpp"

namespace host {

/// One column that the analysis does not interpret; it is kept unchanged.
struct ExtraChannel {
  std::string name;
  std::vector<double> values;     ///< NaN where the field is not a number
  std::vector<std::string> text;  ///< the fields as they stand in the file, when some of them is not a finite number
};

/// Samples of one test. All channels present have the same length N >= 2; row k holds the samples at t_s[k], and the
/// command that was computed from them and applied from then on. Travel and speed are in the drive's own units: rotary:
/// x in mm, w in rad/s; linear: x in m, w in m/s (files in mm and mm/s are scaled when they are read).
struct Record {
  std::string path;                  ///< where it came from, for messages
  std::size_t names_line = 0;        ///< line with the column names in that file (row k is k + 1 lines below); 0: none
  std::vector<std::string> columns;  ///< names of the channels as that file gives them, with its units
  std::string drive;                 ///< `# drive:` of the header; may be empty
  sim::DriveKind kind = sim::DriveKind::rotary;
  bool kind_is_presumed = false;              ///< only a position was recorded, so mm may mean either kind of drive
  double sample_period_s = 0.0;               ///< Ts: the header's where it gives one (t_s agrees), else from t_s
  std::map<std::string, std::string> header;  ///< every `# key: value` line
  std::vector<double> t_s;
  std::vector<double> u_V;     ///< command at the D/A converter; empty when only current was logged
  std::vector<double> i_A;     ///< motor current; empty when absent
  std::vector<double> x;       ///< position as the encoder reads it; empty when absent
  std::vector<double> x2;      ///< position of the table by a sensor of its own; empty when absent
  std::vector<double> w;       ///< speed as the tachometer reads it; empty when absent
  std::vector<double> x_ref;   ///< reference position; empty when absent
  std::vector<double> w_ref;   ///< reference speed; empty when absent
  std::vector<double> temp_C;  ///< empty when absent
  std::vector<ExtraChannel> extra;

  std::size_t size() const { return t_s.size(); }
  bool has_position() const { return !x.empty(); }
  bool has_table_position() const { return !x2.empty(); }
  bool has_speed() const { return !w.empty(); }
};

/// Kelvin above a record's first row; 0 where no temperature was recorded.
inline double warmer_K(const Record& record, std::size_t row) {
  return record.temp_C.empty() ? 0.0 : record.temp_C[row] - record.temp_C.front();
}

}  // namespace host
