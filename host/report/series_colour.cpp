#include "host/report/series_colour.hpp"

namespace host {

const char* series_colour(SeriesRole role) {
  switch (role) {
    case SeriesRole::measured:
      return "#4a5560";
    case SeriesRole::predicted:
    case SeriesRole::before:
      return "#d55e00";
    case SeriesRole::residual:
      return "#aa3377";
    case SeriesRole::after:
    case SeriesRole::model:
    case SeriesRole::validate:
      return "#0072b2";
    case SeriesRole::train:
      return "#56b4e9";
    case SeriesRole::floor:
      return "#9aa5b1";
    case SeriesRole::other:
      break;
  }
  return "#009e73";
}

}  // namespace host
