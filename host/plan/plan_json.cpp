#include "host/plan/plan_json.hpp"

namespace host {

namespace {

nlohmann::json rivals_json(const std::vector<Rival>& rivals) {
  nlohmann::json list = nlohmann::json::array();
  for (const Rival& rival : rivals) list.push_back(rival.kinds);
  return list;
}

nlohmann::json probabilities_json(const std::vector<Rival>& rivals) {
  nlohmann::json list = nlohmann::json::array();
  for (const Rival& rival : rivals) list.push_back(rival.probability);
  return list;
}

nlohmann::json text_or_null(const std::string& text) { return text.empty() ? nlohmann::json() : nlohmann::json(text); }

}  // namespace

nlohmann::json to_json(const Plan& plan, const std::string& run_file) {
  nlohmann::json pairs = nlohmann::json::array(), pieces = nlohmann::json::array();
  for (const PairOutlook& pair : plan.pairs)
    pairs.push_back({{"rivals", {plan.rivals[pair.a].kinds, plan.rivals[pair.b].kinds}},
                     {"separable", pair.separable},
                     {"expected_odds", {pair.odds_if_a, pair.odds_if_b}},
                     {"by_hand", text_or_null(pair.by_hand)}});
  for (const RunPiece& piece : plan.run.pieces) pieces.push_back(piece_text(piece));
  return {{"format", "axis-plan/1"},
          {"rivals", rivals_json(plan.rivals)},
          {"probabilities", probabilities_json(plan.rivals)},
          {"separable", plan.separable},
          {"by_hand", text_or_null(plan.by_hand)},
          {"run", plan.separable ? nlohmann::json(run_file) : nlohmann::json()},
          {"duration_s", plan.run.duration_s()},
          {"expected_odds", plan.expected_odds},
          {"highest_odds", kHighestOdds},
          {"pairs", pairs},
          {"pieces", pieces},
          {"tried", plan.considered.size()},
          {"simulated_samples", plan.steps},
          {"cut_short", plan.cut_short}};
}

nlohmann::json to_json(const Decision& decision) {
  nlohmann::json left = nlohmann::json::array();
  for (const std::size_t k : decision.left) left.push_back(decision.rivals[k].kinds);
  return {{"format", "axis-decision/1"},
          {"rivals", rivals_json(decision.rivals)},
          {"probabilities", probabilities_json(decision.rivals)},
          {"chi_square", decision.chi_square},
          {"dispersion", decision.dispersion},
          {"best", decision.rivals[decision.best].kinds},
          {"odds", decision.odds},
          {"left", left},
          {"explains", decision.explains},
          {"error_over_floor", decision.error}};
}

}  // namespace host
