// The first controller: pole placement on the identified drive, of modest bandwidth.
#include <fmt/format.h>

#include "host/commission/steps.hpp"
#include "host/model/model_file.hpp"

namespace host {

CommissionStepResult control_first(CommissionSession& session) {
  const sim::DriveDescription model = read_model(session.folder().require("identified.toml", "identify"));
  session.plan_limits(model);
  session.download(session.design(model, session.first_loop(model), "first-params.toml"));
  return {{"first-params.toml"},
          fmt::format("Poles at {:.3g} Hz; the parameters are on the board but not saved.",
                      session.first_options().bandwidth_Hz)};
}

}  // namespace host
