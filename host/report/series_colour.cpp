#include "host/report/series_colour.hpp"

namespace host {

const char* series_colour(SeriesRole role) {
  switch (role) {
    case SeriesRole::measured:
      return "var(--measured)";
    case SeriesRole::predicted:
    case SeriesRole::before:
      return "var(--predicted)";
    case SeriesRole::residual:
      return "var(--residual)";
    case SeriesRole::after:
    case SeriesRole::model:
    case SeriesRole::validate:
      return "var(--model)";
    case SeriesRole::train:
      return "var(--train)";
    case SeriesRole::floor:
      return "var(--floor)";
    case SeriesRole::other:
      break;
  }
  return "var(--other)";
}

}  // namespace host
