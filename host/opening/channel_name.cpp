#include "host/opening/channel_name.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "host/number.hpp"
#include "host/opening/name_words.hpp"

namespace host {

namespace {

/// Meanings of a word as bits, because a compound word ("drehzahlsollwert") has several.
enum Sense : unsigned {
  kTime = 1U << 0U,
  kPosition = 1U << 1U,
  kSpeed = 1U << 2U,
  kCurrent = 1U << 3U,
  kTorque = 1U << 4U,
  kForce = 1U << 5U,
  kVoltage = 1U << 6U,
  kTemperature = 1U << 7U,
  kOther = 1U << 8U,  ///< acceleration, errors, status: not used in a record
  kReference = 1U << 9U,
  kMeasured = 1U << 10U,
  kSecond = 1U << 11U,
  kNotTheMotor = 1U << 12U,  ///< d axis, supply, bus: a current or voltage that produces no torque
  kMakesTorque = 1U << 13U,
  kWeak = 1U << 14U,
  kAxis = 1U << 15U,  ///< a number or letter beside it names the axis
  kFiller = 1U << 16U,
};

struct WordSense {
  unsigned sense;
  std::string_view words;  ///< separated by blanks
};

/// Whether `whole` is one of the words.
bool is_among(std::string_view words, std::string_view whole) {
  for (std::size_t at = words.find(whole); at != std::string_view::npos; at = words.find(whole, at + 1)) {
    const std::size_t end = at + whole.size();
    if ((at == 0 || words[at - 1] == ' ') && (end == words.size() || words[end] == ' ')) return true;
  }
  return false;
}

/// Whether one of the words is a part of `whole`.
bool has_part(std::string_view words, std::string_view whole) {
  while (!words.empty()) {
    const std::string_view part = words.substr(0, words.find(' '));
    if (whole.find(part) != std::string_view::npos) return true;
    words.remove_prefix(std::min(part.size() + 1, words.size()));
  }
  return false;
}

/// Words that must match as a whole.
constexpr WordSense kWords[] = {
    {kTime | kWeak, "t ts clock"},
    {kTime,
     "time timestamp stamp zeit temps tiempo tempo uhrzeit millis micros datetime zeitstempel "
     "timems timeus"},
    {kPosition, "pos posn theta lage weg travel angolo"},
    {kPosition | kWeak, "x q y z phi enc encoder counts course cote quota"},
    {kPosition | kWeak | kAxis, "joint"},
    {kSpeed | kWeak, "v w n dq gyro"},
    {kSpeed, "qdot vel velo velocity speed spd omega rpm tach tacho"},
    {kCurrent | kWeak, "i"},
    {kCurrent | kMakesTorque, "iq"},
    {kCurrent, "cur curr amps amp strom ток тока corriente"},
    {kTorque, "torque trq tq tau couple mom moment"},
    {kTorque | kWeak, "par m"},
    {kForce, "force kraft fuerza forza сила усилие"},
    {kForce | kWeak, "f"},
    {kVoltage | kWeak, "u vm output out"},
    {kVoltage, "volt volts uq vq voltaje voltage"},
    {kVoltage | kReference, "dac"},
    {kTemperature, "temp"},
    {kTemperature | kWeak, "tmp"},
    {kOther,
     "fric model sim theor reduced mass range acc err ferror dev lag droop diff status state mode flag fault enable "
     "moving power leistung "
     "duty limit max gain kp ki integral feedrate inertia line selected digital level roll pitch "
     "yaw"},
    {kReference,
     "ref set soll cmd des sp dem goal rif demand reference desired demanded consigne consigna "
     "planned"},
    {kMeasured, "act actual ist meas fb feedback real est estimate mes measured fbk"},
    {kSecond, "load scale glass table linear second direct tisch last link"},
    {kNotTheMotor, "bus supply battery in input d dc phase"},
    {kVoltage | kNotTheMotor, "vsupply vbus vbat ud vd"},
    {kCurrent | kNotTheMotor, "ibus id"},
    {kSpeed | kNotTheMotor, "erpm"},
    {kAxis, "axis achse axe eje asse ось оси servo drive pid ax"},
    {kFiller, "motor value wert averaged control controller main of per"},
};

/// Parts of compound words. Longer ones come first.
constexpr WordSense kParts[] = {
    {kTime, "zeit время времен 时间 時間 時刻"},
    {kPosition, "posi lage winkel angle angul ángulo угол угл положен позиц 位置 角度 座標 坐标 displacement"},
    {kSpeed, "geschw drehzahl vitesse velocid velocit veloc speed скорост оборот 速度 转速 回転"},
    {kCurrent, "current strom courant corrient corrente 电流 電流"},
    {kTorque, "torque moment момент 转矩 扭矩 力矩 トルク coppia"},
    {kForce, "kraft усили 推力"},
    {kVoltage, "spannung tension tensión напряж 电压 電圧"},
    {kTemperature, "temperat températ температ 温度"},
    {kOther,
     "accel accél aceler beschleunig ускор 加速度 error erreur fehler schlepp abweich écart ошибк "
     "рассоглас 偏差 following deviation inertia frequency program sequence"},
    {kReference,
     "soll command target setpoint setwert consign riferiment referenc задан устав 指令 目标 目標 给定 "
     "objetivo comand"},
    {kMeasured,
     "istwert mesur effettiv attual actuel actual réel medid misurat факт измер 实际 反馈 実 现在 現在 "
     "measur"},
    {kMakesTorque, "momentenbildend"},
    {kAxis, "轴 軸"},
};

unsigned sense_of_whole(std::string_view word) {
  for (const WordSense& known : kWords)
    if (is_among(known.words, word)) return known.sense;
  return 0;
}

unsigned sense_of(std::string_view word) {
  if (const unsigned whole = sense_of_whole(word); whole != 0) return whole;
  constexpr std::size_t kLetterAndIst = 4;  // "iist", "nsoll": a letter, and actual value or set point
  for (const auto& [end, sense] :
       {std::pair{std::string_view("ist"), kMeasured}, std::pair{std::string_view("soll"), kReference}})
    if (word.ends_with(end) && word.size() <= kLetterAndIst + 1 && word.size() == end.size() + 1)
      return (sense_of_whole(word.substr(0, 1)) & ~static_cast<unsigned>(kWeak)) | sense;
  // "actpos", "setvel", "posact", "velcmd"
  for (const auto& [part, sense] :
       {std::pair{std::string_view("act"), kMeasured}, std::pair{std::string_view("set"), kReference},
        std::pair{std::string_view("cmd"), kReference}, std::pair{std::string_view("ref"), kReference},
        std::pair{std::string_view("ist"), kMeasured}}) {
    if (word.starts_with(part) && sense_of_whole(word.substr(part.size())) != 0)
      return sense_of_whole(word.substr(part.size())) | sense;
    if (word.ends_with(part) && sense_of_whole(word.substr(0, word.size() - part.size())) != 0)
      return sense_of_whole(word.substr(0, word.size() - part.size())) | sense;
  }
  unsigned found = 0;
  for (const WordSense& part : kParts)
    if (has_part(part.words, word)) found |= part.sense;
  if (word.starts_with("ist") && found != 0) found |= kMeasured;
  return found;
}

constexpr unsigned kQuantities =
    kTime | kPosition | kSpeed | kCurrent | kTorque | kForce | kVoltage | kTemperature | kOther;

/// The main quantity of a name with several meanings: "momentenbildender Strom" is a current; "position error" is not
/// used.
ChannelQuantity one_of(unsigned senses) {
  if ((senses & kOther) != 0) return ChannelQuantity::other;
  if ((senses & kTime) != 0) return ChannelQuantity::time;
  if ((senses & kTemperature) != 0) return ChannelQuantity::temperature;
  if ((senses & kCurrent) != 0) return ChannelQuantity::current;
  if ((senses & kTorque) != 0) return ChannelQuantity::torque;
  if ((senses & kForce) != 0) return ChannelQuantity::force;
  if ((senses & kVoltage) != 0) return ChannelQuantity::voltage;
  if ((senses & kSpeed) != 0) return ChannelQuantity::speed;
  return (senses & kPosition) != 0 ? ChannelQuantity::position : ChannelQuantity::unknown;
}

bool suits(ChannelQuantity quantity, Dimension dimension) {
  switch (quantity) {
    case ChannelQuantity::time:
      return dimension == Dimension::time;
    case ChannelQuantity::position:
      return dimension == Dimension::angle || dimension == Dimension::length || dimension == Dimension::counts;
    case ChannelQuantity::speed:
      return dimension == Dimension::angular_speed || dimension == Dimension::linear_speed ||
             dimension == Dimension::count_speed || dimension == Dimension::share;
    case ChannelQuantity::current:
      return dimension == Dimension::current || dimension == Dimension::share;
    case ChannelQuantity::torque:
      return dimension == Dimension::torque || dimension == Dimension::force || dimension == Dimension::share ||
             dimension == Dimension::current;
    case ChannelQuantity::force:
      return dimension == Dimension::force;
    case ChannelQuantity::voltage:
      return dimension == Dimension::voltage || dimension == Dimension::share;
    case ChannelQuantity::temperature:
      return dimension == Dimension::temperature;
    default:
      return false;
  }
}

/// The quantity that a unit implies if the name gives none.
ChannelQuantity quantity_of(Dimension dimension) {
  switch (dimension) {
    case Dimension::time:
      return ChannelQuantity::time;
    case Dimension::angle:
    case Dimension::length:
    case Dimension::counts:
      return ChannelQuantity::position;
    case Dimension::angular_speed:
    case Dimension::linear_speed:
    case Dimension::count_speed:
      return ChannelQuantity::speed;
    case Dimension::current:
      return ChannelQuantity::current;
    case Dimension::torque:
      return ChannelQuantity::torque;
    case Dimension::force:
      return ChannelQuantity::force;
    case Dimension::temperature:
      return ChannelQuantity::temperature;
    case Dimension::acceleration:
      return ChannelQuantity::other;
    default:
      return ChannelQuantity::unknown;
  }
}

/// A name and its unit, which is in brackets, after a comma or "in", or at the end of the name.
struct NameAndUnit {
  std::string name, unit;
};

std::optional<NameAndUnit> in_brackets(std::string_view name) {
  for (const auto& [open, close] :
       {std::pair{'[', ']'}, std::pair{'(', ')'}, std::pair{'<', '>'}, std::pair{'{', '}'}}) {
    const std::size_t begin = name.rfind(open), end = name.rfind(close);
    if (begin == std::string_view::npos || end == std::string_view::npos || end < begin) continue;
    const std::string_view unit = trim_blanks(name.substr(begin + 1, end - begin - 1));
    if (unit_named(unit))
      return NameAndUnit{std::string(name.substr(0, begin)) + std::string(name.substr(end + 1)), std::string(unit)};
  }
  return std::nullopt;
}

/// Units after the last comma, slash, underscore, blank or dash: "Weg / mm", "pos_mm", "w_rad_s", "speed rpm".
std::vector<NameAndUnit> at_the_end(std::string_view name) {
  std::vector<NameAndUnit> found;
  int cuts = 0;
  for (std::size_t at = name.find_last_of(",/_ -."); at != std::string_view::npos && at > 0 && cuts < 3;
       at = name.find_last_of(",/_ -.", at - 1), ++cuts) {
    const std::string_view unit = trim_blanks(name.substr(at + 1));
    if (unit_named(unit)) found.push_back({std::string(name.substr(0, at)), std::string(unit)});
  }
  std::ranges::reverse(found);  // the longest unit first
  return found;
}

struct Words {
  unsigned senses = 0;
  std::string axis;
};

bool is_number(std::string_view word) {
  return !word.empty() && std::isdigit(static_cast<unsigned char>(word.front())) != 0;
}

/// "Analog 1": the number belongs to the logger, not to an axis.
bool is_channel_number(std::string_view word) {
  return word == "analog" || word == "digital" || word == "ch" || word == "chan" || word == "channel" ||
         word == "kanal" || word == "input";
}

bool is_axis_letter(std::string_view word) {
  return word.size() == 1 && std::string_view("xyzabcsuvw").find(word.front()) != std::string_view::npos;
}

/// Combines the meanings of the words. A letter or number that is not a quantity names the axis.
Words read_words(std::string_view name) {
  const std::vector<std::string> words = words_of(name);
  Words read;
  unsigned strong = 0, weak = 0;
  std::string letter;
  for (const std::string& word : words) {
    const unsigned sense = sense_of(word);
    const bool may_be_axis = is_axis_letter(word);
    if ((sense & kWeak) == 0) {
      strong |= sense;
    } else if (!may_be_axis) {
      weak |= sense;
    }
    if (may_be_axis && letter.empty()) letter = word;
  }
  const bool says_quantity = (strong & kQuantities) != 0;
  for (std::size_t k = 0; k < words.size(); ++k) {
    const bool behind_letter = k > 0 && words[k - 1] == letter;
    if (k > 0 && is_channel_number(words[k - 1])) continue;
    if (is_number(words[k]) && words[k].size() <= 2) read.axis += behind_letter || read.axis.empty() ? words[k] : "";
    if (says_quantity && words[k] == letter && read.axis.empty() && sense_of_whole(words[k]) != 0) read.axis = letter;
    if (says_quantity && words[k] == letter && read.axis.empty()) read.axis = letter;
  }
  if (!says_quantity && !letter.empty()) weak |= sense_of_whole(letter);
  read.senses = says_quantity ? strong | (weak & ~kQuantities & ~static_cast<unsigned>(kWeak)) : strong | weak;
  return read;
}

}  // namespace

ChannelName understand_name(const LogColumn& column) {
  ChannelName result;
  std::string name = column.name;
  std::vector<NameAndUnit> parts;
  if (!column.unit.empty()) {
    result.unit_text = column.unit;
    result.unit = unit_named(column.unit);
  } else if (auto bracketed = in_brackets(name)) {
    parts.push_back(std::move(*bracketed));
  } else {
    parts = at_the_end(name);
  }
  Words words = read_words(name);
  for (const NameAndUnit& part : parts) {
    const Words without = read_words(part.name);
    const UnitMeaning unit = *unit_named(part.unit);
    const bool is_bracketed =
        name.find(part.unit + "]") != std::string::npos || name.find(part.unit + ")") != std::string::npos;
    if (!is_bracketed && !suits(one_of(without.senses), unit.dimension)) continue;
    result.unit_text = part.unit;
    result.unit = unit;
    words = without;
    break;
  }
  result.quantity = one_of(words.senses);
  result.is_weak = (words.senses & kWeak) != 0;
  if (result.unit) {
    const ChannelQuantity by_unit = quantity_of(result.unit->dimension);
    const bool says_nothing = result.quantity == ChannelQuantity::unknown;
    if (says_nothing ||
        (result.is_weak && by_unit != ChannelQuantity::unknown && !suits(result.quantity, result.unit->dimension)))
      result.quantity = by_unit;
  }
  if ((words.senses & kNotTheMotor) != 0 && result.quantity != ChannelQuantity::time &&
      result.quantity != ChannelQuantity::temperature && result.quantity != ChannelQuantity::position)
    result.quantity = ChannelQuantity::other;
  result.is_reference = (words.senses & kReference) != 0;
  result.is_measured = (words.senses & kMeasured) != 0;
  result.is_second = (words.senses & kSecond) != 0;
  result.makes_torque =
      (words.senses & kMakesTorque) != 0 || ((words.senses & kCurrent) != 0 && (words.senses & kTorque) != 0);
  result.axis = words.axis;
  return result;
}

std::string_view quantity_name(ChannelQuantity quantity) {
  static constexpr std::array<std::string_view, 10> kNames{"unknown", "time",  "position", "speed",       "current",
                                                           "torque",  "force", "voltage",  "temperature", "other"};
  return kNames[static_cast<std::size_t>(quantity)];
}

}  // namespace host
