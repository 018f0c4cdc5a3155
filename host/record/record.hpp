// A measurement: evenly sampled channels of one axis, as in `axis-record/1`.
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
  std::vector<std::string> text;  ///< the fields in the file, if one of them is not a finite number
};

/// Samples of one test. All channels that are present have the same length N >= 2. Row k contains the samples at t_s[k]
/// and the command that was computed from them and applied from then on. Travel and speed are in the units of the
/// drive: x in mm and w in rad/s if rotary, x in m and w in m/s if linear (files in mm and mm/s are scaled when they
/// are read).
struct Record {
  std::string path;                  ///< path of the file, for messages
  std::size_t names_line = 0;        ///< line with the column names (row k is k + 1 lines below); 0 if there is none
  std::vector<std::string> columns;  ///< names of the channels in that file, with its units
  std::string drive;                 ///< `# drive:` in the header; may be empty
  sim::DriveKind kind = sim::DriveKind::rotary;
  bool kind_is_presumed = false;              ///< only a position was recorded, so either kind is possible
  double sample_period_s = 0.0;               ///< Ts: from the header if it gives one (t_s agrees), else from t_s
  std::map<std::string, std::string> header;  ///< every `# key: value` line
  std::vector<double> t_s;
  std::vector<double> u_V;     ///< command at the D/A converter; empty if only the current was logged
  std::vector<double> i_A;     ///< motor current; empty if absent
  std::vector<double> x;       ///< encoder position; empty if absent
  std::vector<double> x2;      ///< position of the table from its own sensor; empty if absent
  std::vector<double> w;       ///< tachometer speed; empty if absent
  std::vector<double> x_ref;   ///< reference position; empty if absent
  std::vector<double> w_ref;   ///< reference speed; empty if absent
  std::vector<double> temp_C;  ///< empty if absent
  std::vector<ExtraChannel> extra;

  std::size_t size() const { return t_s.size(); }
  bool has_position() const { return !x.empty(); }
  bool has_table_position() const { return !x2.empty(); }
  bool has_speed() const { return !w.empty(); }
};

/// Temperature above that of the first row, K; 0 if no temperature was recorded.
inline double warmer_K(const Record& record, std::size_t row) {
  return record.temp_C.empty() ? 0.0 : record.temp_C[row] - record.temp_C.front();
}

}  // namespace host
