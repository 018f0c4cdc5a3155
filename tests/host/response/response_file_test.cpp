// Response files of `bode` can be read again, and no other content crashes the program.
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "host/exit_codes.hpp"
#include "host/response/axis_response.hpp"
#include "tests/host/temporary_folder.hpp"

namespace {

using nlohmann::json;

/// A double integrator after a hold, with 1 % of uncertainty.
json document() {
  host::AxisResponse axis;
  host::FrequencyResponse& response = axis.response;
  response.sample_period_s = 1e-3;
  response.has_position = true;
  for (double f = 4.0; f < 250.0; f *= 1.2) {
    host::ResponseLine line;
    line.f_Hz = f;
    line.plant(0) = std::polar(1e5 / (f * f), -3.1 - 0.003 * f);
    line.covariance(0, 0) = 2.0 * std::norm(0.01 * line.plant(0));
    line.degrees = 9.0;
    response.lines.push_back(line);
  }
  return host::response_json(axis);
}

/// Pointers to all numbers and lists of a document.
std::vector<json::json_pointer> places(const json& document) {
  std::vector<json::json_pointer> found;
  const json flat = document.flatten();
  for (const auto& [path, value] : flat.items()) {
    found.emplace_back(path);
    for (json::json_pointer above = found.back(); !above.empty(); above.pop_back())
      if (found.size() < 5000) found.push_back(above);
  }
  return found;
}

TEST(ResponseFile, ReadsBack) {
  const TemporaryFolder folder;
  const host::AxisResponse read = host::read_response(folder.write("r.json", document().dump()));
  EXPECT_EQ(read.response.lines.size(), document()["f_Hz"].size());
  EXPECT_TRUE(read.fit.has_value());
}

/// Catches access to a Jacobian that the solver has not computed.
TEST(ResponseFile, OfWildValuesIsRefused) {
  const TemporaryFolder folder;
  for (const char* place : {"/plant/re/3", "/plant/im/0", "/covariance/2/0", "/f_Hz/1", "/sample_period_s", "/noise/0",
                            "/coherence/1", "/degrees/4"})
    for (const double wild : {1e300, -1e300, -1.0}) {
      json bent = document();
      if (wild == -1.0 && std::string_view(place).starts_with("/plant")) continue;  // the other half of the plane
      bent[json::json_pointer(place)] = wild;
      try {
        host::read_response(folder.write("r.json", bent.dump()));
        ADD_FAILURE() << place << " = " << wild << " was taken";
      } catch (const host::Failure& failure) {
        EXPECT_EQ(failure.code, host::ExitCode::bad_input) << place << " = " << wild;
      }
    }
}

TEST(ResponseFile, OfAnyJsonIsReadOrRefused) {
  const TemporaryFolder folder;
  const json good = document();
  const std::vector<json::json_pointer> all = places(good);
  const std::vector<json> values = {nullptr, true, -1, 0, 1e308, 5e-324, "x", json::array(), json::object(), 1u << 31U};
  std::mt19937 random(3);
  for (int trial = 0; trial < 12; ++trial) {
    json bent = good;
    for (auto times = 1 + random() % 3; times > 0; --times) {
      const json::json_pointer& place = all[random() % all.size()];
      if (bent.contains(place)) bent[place] = values[random() % values.size()];
    }
    try {
      host::read_response(folder.write("r.json", bent.dump()));
    } catch (const host::Failure&) {  // refused, in words
    }
  }
}

}  // namespace
