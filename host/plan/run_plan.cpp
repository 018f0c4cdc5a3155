#include "host/plan/run_plan.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "host/atomic_file.hpp"
#include "host/exit_codes.hpp"
#include "host/read_file.hpp"
#include "host/toml_fields.hpp"
#include "host/toml_text.hpp"

namespace host {

namespace {

constexpr std::string_view kFormat = "axis-run-plan/1";

/// "3 -3 hold=0.3"
std::string numbers_text(const ExcitationNumbers& numbers) {
  std::vector<std::string> words;
  for (const double value : numbers.list) words.push_back(fmt::format("{:g}", value));
  for (const auto& [name, value] : numbers.named) words.push_back(fmt::format("{}={:g}", name, value));
  return fmt::format("{}", fmt::join(words, " "));
}

}  // namespace

double RunPlan::duration_s() const {
  double sum = 0.0;
  for (const RunPiece& piece : pieces) sum += piece.time_s;
  return sum;
}

std::string piece_text(const RunPiece& piece) {
  const std::string numbers = numbers_text(piece.numbers);
  return fmt::format("{}{}{}{}, {:g} s", piece.kind, numbers.empty() ? "" : " ", numbers,
                     piece.closed_loop.empty() ? "" : ", added to the " + piece.closed_loop, piece.time_s);
}

Excitation design_piece(const RunPiece& piece, const ExcitationLimits& box, double offset,
                        const ExcitationScale& scale) {
  ExcitationLimits own = box;
  own.travel = box.travel - 2.0 * std::abs(offset);
  own.time_s = piece.time_s;
  if (!(own.travel > 0.0))
    throw Failure(ExitCode::refused, fmt::format("{}: the axis is {:g} from the start of the run, at the edge of its "
                                                 "box of travel = {:g}: move it back, or widen travel",
                                                 piece.kind, offset, box.travel));
  return design_excitation(piece.kind, piece.numbers, own, scale, piece.closed_loop, piece.seed);
}

ExcitationLimits within_both(const ExcitationLimits& a, const ExcitationLimits& b) {
  return {std::min(a.travel, b.travel), std::min(a.speed, b.speed), std::min(a.volts, b.volts),
          std::min(a.time_s, b.time_s)};
}

std::map<std::string, std::string> run_header(const RunPlan& run) {
  std::map<std::string, std::string> header;
  header["excitation"] = "plan";
  header["excitation_box"] = fmt::format("travel={:g} speed={:g} volts={:g} time={:g}", run.box.travel, run.box.speed,
                                         run.box.volts, run.box.time_s);
  for (std::size_t k = 0; k < run.pieces.size(); ++k)
    header[fmt::format("excitation_piece_{}", k + 1)] = piece_text(run.pieces[k]);
  if (!run.rivals.empty()) header["excitation_rivals"] = fmt::format("{}", fmt::join(run.rivals, ", "));
  if (run.expected_odds > 0.0) header["excitation_expected_odds"] = fmt::format("{:.4g}", run.expected_odds);
  return header;
}

std::string run_plan_toml(const RunPlan& run) {
  std::string text = fmt::format("format = \"{}\"\n", kFormat);
  if (!run.rivals.empty()) text += fmt::format("rivals = [\"{}\"]\n", fmt::join(run.rivals, "\", \""));
  if (run.expected_odds > 0.0) text += fmt::format("expected_odds = {}\n", toml_number(run.expected_odds));
  text += fmt::format("\n[box]  # mm (linear: m), mm/s, V, s\ntravel = {}\nspeed = {}\nvolts = {}\ntime = {}\n",
                      toml_number(run.box.travel), toml_number(run.box.speed), toml_number(run.box.volts),
                      toml_number(run.box.time_s));
  for (const RunPiece& piece : run.pieces) {
    text += fmt::format("\n[[piece]]\nkind = \"{}\"\ntime_s = {}\n", piece.kind, toml_number(piece.time_s));
    if (!piece.closed_loop.empty()) text += fmt::format("closed_loop = \"{}\"\n", piece.closed_loop);
    if (piece.seed != 1) text += fmt::format("seed = {}\n", piece.seed);
    std::vector<std::string> values;
    for (const double value : piece.numbers.list) values.push_back(toml_number(value));
    if (!values.empty()) text += fmt::format("values = [{}]\n", fmt::join(values, ", "));
    if (!piece.numbers.named.empty()) text += "[piece.numbers]\n";
    for (const auto& [name, value] : piece.numbers.named) text += fmt::format("{} = {}\n", name, toml_number(value));
  }
  return text;
}

RunPlan parse_run_plan(std::string_view text, const std::string& name) {
  const toml::table table = parse_toml(text, name);
  TomlFields fields(table, name, "the run");
  if (fields.text("format") != kFormat)
    fields.fail("format", fmt::format("this is not a planned run; `axistool plan` writes {}", kFormat));
  RunPlan run;
  run.rivals = fields.texts("rivals");
  run.expected_odds = fields.number("expected_odds", 0.0);
  const toml::table* box = fields.sub_table("box");
  if (box == nullptr) fields.fail("box", "missing; add [box] with travel, speed, volts and time");
  TomlFields sides(*box, name, "[box]");
  for (auto [side, key] : {std::pair{&ExcitationLimits::travel, "travel"},
                           {&ExcitationLimits::speed, "speed"},
                           {&ExcitationLimits::volts, "volts"},
                           {&ExcitationLimits::time_s, "time"}}) {
    run.box.*side = sides.number(key);
    if (!(run.box.*side > 0.0)) sides.fail(key, "it must be above 0");
  }
  for (const toml::table* part : fields.tables("piece")) {
    TomlFields own(*part, name, "[[piece]]");
    RunPiece piece;
    piece.kind = own.text("kind");
    piece.time_s = own.number("time_s");
    if (!(piece.time_s > 0.0)) own.fail("time_s", "it must be above 0");
    piece.closed_loop = own.optional_text("closed_loop").value_or("");
    const double seed = own.number("seed", 1.0);
    if (!(seed >= 0.0 && seed <= 4294967295.0)) own.fail("seed", "expected a whole number from 0");
    piece.seed = static_cast<unsigned>(seed);
    piece.numbers.list = own.numbers("values");
    if (const toml::table* named = own.sub_table("numbers")) {
      TomlFields each(*named, name, "[piece.numbers]");
      for (const auto& [key, node] : *named) piece.numbers.named[std::string(key.str())] = each.number(key.str());
    }
    own.refuse_rest();
    run.pieces.push_back(std::move(piece));
  }
  sides.refuse_rest();
  fields.refuse_rest();
  if (run.pieces.empty()) fields.fail("piece", "the run has no [[piece]]; `axistool plan` writes them");
  if (run.duration_s() > run.box.time_s + 1e-9)
    fields.fail("box", fmt::format("its pieces take {:g} s, more than the box's time", run.duration_s()));
  return run;
}

RunPlan read_run_plan(const std::string& path) { return parse_run_plan(read_file(path), path); }

void write_run_plan(const RunPlan& run, const std::string& path) { write_file_atomically(path, run_plan_toml(run)); }

}  // namespace host
