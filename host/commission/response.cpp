// The frequency response.
#include "host/commission/steps.hpp"

namespace host {

CommissionStepResult measure_response(CommissionSession&) {
  return {{}, "Not measured: the bandwidth stays as it was designed."};
}

}  // namespace host
