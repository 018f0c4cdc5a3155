// Drives that hide some effects of the catalogue, for `axistool scoreboard`: made_machines SEED COUNT EFFECTS DIRECTORY
// The plant is independent of the simulator: steps of 20 us, friction as an impulse that at most stops the motion.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

using std::string;
constexpr double kPi = 3.14159265358979323846, kRow_s = 1e-3;
constexpr int kParts = 50;
constexpr double kStep_s = kRow_s / kParts;

struct Drive {
  double amplifier, torque_constant = 0.4769, lead = 10.0 / (2.0 * kPi), resolution = 10.0 / 4096.0, tach_variance;
  double inertia, viscous, forward, backward, extra, fade;  // extra: static over Coulomb, 0: none
  std::map<string, std::map<string, double>> hidden;
  double of(const string& kind, const string& name, double otherwise) const {
    const auto found = hidden.find(kind);
    return found == hidden.end() ? otherwise : found->second.at(name);
  }
  bool has(const string& kind) const { return hidden.count(kind) != 0; }
};

struct Random {
  std::mt19937_64 engine;
  double between(double low, double high) { return std::uniform_real_distribution<>(low, high)(engine); }
  double either(double low, double high) { return (between(0, 1) < 0.5 ? -1 : 1) * between(low, high); }
  double normal() { return std::normal_distribution<>()(engine); }
  template <class T>
  T one(const std::vector<T>& of) {
    return of[std::uniform_int_distribution<std::size_t>(0, of.size() - 1)(engine)];
  }
};

struct Row {
  double t, u, x, w;
};

double held(double speed, double most) { return std::abs(speed) <= most ? 0.0 : speed - std::copysign(most, speed); }

struct Plant {
  const Drive& d;
  Random noise;
  double x = 0, w = 0, x2 = 0, w2 = 0, current = 0, tach = 0, bristle = 0, lagged = 0, rest = 10.0, aged = 1.0, t = 0;
  std::vector<double> late = std::vector<double>(400, 0.0);
  std::size_t at = 0;

  double reading_x() const {
    double mm = x * d.lead;
    if (d.has("encoder_cyclic_error"))
      mm +=
          d.of("encoder_cyclic_error", "size", 0) *
          std::sin(2 * kPi * mm / d.of("encoder_cyclic_error", "period", 1) + d.of("encoder_cyclic_error", "phase", 0));
    return d.resolution * std::round(mm / d.resolution);
  }
  double reading_w() {
    double value = d.of("tach_lag", "Hz", 0) > 0 ? tach : w;
    value *= d.of("tach_gain", "gain", 1);
    if (d.has("tach_ripple"))
      value *= 1 + d.of("tach_ripple", "size", 0) * std::sin(d.of("tach_ripple", "order", 1) * x + 0.7);
    return value + d.of("tach_offset", "offset", 0) + std::sqrt(d.tach_variance) * noise.normal();
  }
  void row(double u) {
    u = std::clamp(std::round(u / 3.0517578125e-4) * 3.0517578125e-4, -10.0, 10.0);
    for (int part = 0; part < kParts; ++part) step(u);
  }
  void step(double u) {
    late[at] = u;
    const auto back = static_cast<std::size_t>(std::llround(d.of("input_delay", "s", 0) / kStep_s));
    u = late[(at + late.size() - back % late.size()) % late.size()];
    at = (at + 1) % late.size();
    u += d.of("dac_offset", "V", 0);
    const double dead = d.of("dac_dead_zone", "V", 0);
    u = std::abs(u) <= dead ? 0.0 : u - std::copysign(dead, u);
    const double asked = d.amplifier * u, bandwidth = d.of("current_loop_lag", "Hz", 0);
    current = bandwidth > 0 ? current + kStep_s * 2 * kPi * bandwidth * (asked - current) : asked;
    const double most = d.of("current_saturation", "A", 1e9), given = std::clamp(current, -most, most);
    double motor = d.torque_constant * given;
    if (d.has("torque_ripple"))
      motor *= 1 + d.of("torque_ripple", "size", 0) *
                       std::sin(d.of("torque_ripple", "order", 1) * x + d.of("torque_ripple", "phase", 0));
    double push = motor + d.of("constant_torque", "Nm", 0);
    if (d.has("cogging"))
      push += d.of("cogging", "size", 0) *
              std::sin(2 * kPi * x * d.lead / d.of("cogging", "period", 1) + d.of("cogging", "phase", 0));
    if (d.has("spring_torque"))
      push -= d.of("spring_torque", "k", 0) * (x * d.lead - d.of("spring_torque", "centre", 0));

    const double warm =
        d.has("thermal_friction_drift") ? 1 - std::exp(-t / d.of("thermal_friction_drift", "tau", 1)) : 0.0;
    const double dry = 1 + d.of("thermal_friction_drift", "dry", 0) * warm,
                 wet = 1 + d.of("thermal_friction_drift", "wet", 0) * warm;
    const double way = w != 0 ? std::copysign(1.0, w) : std::copysign(1.0, push);
    const double part = d.of("coulomb_asymmetry", "part", 0);
    double coulomb = (way > 0 ? d.forward : d.backward) * (1 + way * part) * dry;
    if (d.has("position_dependent_friction"))
      coulomb *= 1 + d.of("position_dependent_friction", "size", 0) *
                         std::sin(2 * kPi * (x * d.lead) / d.of("position_dependent_friction", "period", 1) +
                                  d.of("position_dependent_friction", "phase", 0));
    double extra = d.has("stribeck") ? d.of("stribeck", "extra", 0) : d.extra;
    const double fade = d.has("stribeck") ? d.of("stribeck", "fade", 1) : d.fade;
    const double slow = d.has("friction_lag") ? lagged : std::abs(w);
    if (d.has("friction_lag")) lagged += kStep_s / d.of("friction_lag", "tau", 1) * (std::abs(w) - lagged);
    double level = coulomb;
    if (extra > 0) {
      if (d.has("dwell_stiction")) {
        if (w == 0)
          rest += kStep_s;
        else if (rest > 0)
          aged = 1 + d.of("dwell_stiction", "gain", 0) * (1 - std::exp(-rest / d.of("dwell_stiction", "tau", 1))),
          rest = 0;
        if (w == 0)
          aged = 1 + d.of("dwell_stiction", "gain", 0) * (1 - std::exp(-rest / d.of("dwell_stiction", "tau", 1)));
      }
      level = coulomb * ((1 + extra) * aged * std::exp(-slow / fade) + 1 - std::exp(-slow / fade));
    }
    if (d.has("load_dependent_friction")) level += d.of("load_dependent_friction", "part", 0) * std::abs(motor);
    if (d.has("nonlinear_viscous"))
      level +=
          d.of("nonlinear_viscous", "size", 0) * std::pow(std::abs(w) / 10.0, d.of("nonlinear_viscous", "exponent", 2));
    const double viscous = d.viscous * wet * (1 + way * d.of("viscous_asymmetry", "part", 0)) * std::abs(w);
    double J = d.inertia;
    if (d.has("presliding")) {
      const double s0 = d.of("presliding", "sigma0", 1), s1 = d.of("presliding", "sigma1", 0);
      const double change = w - s0 * std::abs(w) * bristle / level;
      push -= s0 * bristle + s1 * change + std::copysign(viscous, w);
      bristle += kStep_s * change;
      w += kStep_s * push / J;
    } else {
      const string two = d.has("backlash") ? "backlash" : d.has("compliance") ? "compliance" : "";
      double on_motor = level + viscous;
      if (!two.empty()) {
        const double share = d.of(two, "share", 0.3), omega = 2 * kPi * d.of(two, "Hz", 100), load = share * J,
                     rotor = J - load;
        const double k = omega * omega * load * rotor / J,
                     c = 2 * d.of(two, "damping", 0.05) * omega * load * rotor / J;
        const double half = 0.5 * d.of("backlash", "mm", 0) / d.lead, raw = x - x2,
                     twist = raw - std::clamp(raw, -half, half);
        double spring = twist == 0 && half > 0 ? 0 : k * twist + c * (w - w2);
        if (half > 0 && spring * twist < 0) spring = 0;
        const double p = d.of(two, "load_friction", 0);
        push -= spring;
        w2 = held(w2 + kStep_s * spring / load, kStep_s * p * on_motor / load);
        x2 += kStep_s * w2;
        on_motor *= 1 - p;
        J = rotor;
      }
      w = held(w + kStep_s * push / J, kStep_s * on_motor / J);
    }
    x += kStep_s * w;
    t += kStep_s;
    if (d.has("tach_lag")) tach += kStep_s * 2 * kPi * d.of("tach_lag", "Hz", 1) * (w - tach);
  }
};

using Control = std::function<double(int, double, double)>;

std::vector<Row> run(const Drive& drive, std::uint64_t seed, int rows, const Control& control) {
  Plant plant{drive, {std::mt19937_64(seed)}};
  std::vector<Row> log;
  for (int k = 0; k < rows; ++k) {
    const double x = plant.reading_x(), w = plant.reading_w(), u = std::clamp(control(k, x, w), -10.0, 10.0);
    log.push_back({k * kRow_s, u, x, w});
    plant.row(u);
  }
  return log;
}

Control follow(const Drive& d, std::vector<double> path, std::function<double(int)> beside) {
  const double per_volt = d.amplifier * d.torque_constant;
  auto integral = std::make_shared<double>(0.0);
  return [=, path = std::move(path)](int k, double x, double w) {
    const auto i = static_cast<std::size_t>(k);
    const double ahead = i + 1 < path.size() ? (path[i + 1] - path[i]) / kRow_s / d.lead : 0.0;
    const double late = (path[i] - x) / d.lead, off = ahead - w + 40.0 * late;
    *integral = std::clamp(*integral + 8.0 * off * kRow_s * d.inertia, -2.0, 2.0);
    return (110.0 * d.inertia * off + 60.0 * *integral + d.forward * std::tanh(ahead / 0.5) * 0.8) / per_volt +
           beside(k);
  };
}

void move_to(std::vector<double>& path, double there, double top, double rest_s) {
  const double here = path.empty() ? 0.0 : path.back(), length = std::abs(there - here);
  const int rows = std::max(60, static_cast<int>(1.6 * length / top / kRow_s));
  for (int k = 1; k <= rows; ++k) {
    const double p = static_cast<double>(k) / rows;
    path.push_back(here + (there - here) * (p * p * p * (10 - 15 * p + 6 * p * p)));
  }
  path.insert(path.end(), static_cast<std::size_t>(rest_s / kRow_s), there);
}

std::vector<double> jog_path(Random& r, int rows) {
  std::vector<double> path(200, 0.0);
  const std::vector<double> speeds{1, 2, 4, 8, 15, 25, 40, 60, 80, 100, 130, 160};
  for (std::size_t n = 0; path.size() < static_cast<std::size_t>(rows); ++n) {
    const double v = speeds[n % speeds.size()] * r.between(0.9, 1.1), seconds = r.between(0.6, 1.1);
    for (const int sign : {1, -1}) {
      const int ramp = std::max(20, static_cast<int>(v / 1.5)), flat = static_cast<int>(seconds / kRow_s);
      for (int k = -ramp; k < flat + ramp; ++k) {
        const double part = std::clamp(std::min(k + ramp, flat + ramp - k) / static_cast<double>(ramp), 0.0, 1.0);
        path.push_back(path.back() + sign * v * part * kRow_s);
      }
      if (r.between(0, 1) < 0.6)
        path.insert(path.end(), static_cast<std::size_t>(r.between(0.05, 1.5) / kRow_s), path.back());
    }
    if (n % 3 == 1)
      for (int k = 0; k < 8; ++k) move_to(path, path.back() + (k % 2 == 0 ? 1 : -1) * r.between(0.05, 0.6), 4.0, 0.02);
  }
  path.resize(static_cast<std::size_t>(rows));
  return path;
}

void write(const string& name, const std::vector<Row>& rows) {
  FILE* f = std::fopen(name.c_str(), "w");
  std::fprintf(f, "# format: axis-record/1\n# drive: made\n# sample_period_s: 0.001\nt_s,u_V,x_mm,w_rad_s\n");
  for (const Row& r : rows) std::fprintf(f, "%.3f,%.7g,%.9g,%.6g\n", r.t, r.u, r.x, r.w);
  std::fclose(f);
}

std::map<string, double> sizes(const string& kind, Random& r) {
  const double phase = r.between(0, 2 * kPi);
  if (kind == "cogging")
    return {{"size", r.between(0.12, 0.35)}, {"period", r.one<double>({1.25, 2.5, 5, 10})}, {"phase", phase}};
  if (kind == "torque_ripple")
    return {{"size", r.between(0.06, 0.13)}, {"order", r.one<double>({2, 4, 6, 8})}, {"phase", phase}};
  if (kind == "position_dependent_friction")
    return {{"size", r.between(0.15, 0.3)}, {"period", r.between(60, 140)}, {"phase", phase}};
  if (kind == "compliance")
    return {{"Hz", r.between(45, 100)},
            {"damping", r.between(0.03, 0.06)},
            {"share", r.between(0.25, 0.5)},
            {"load_friction", r.one<double>({0, 0, 0.4})}};
  if (kind == "backlash")
    return {{"mm", r.between(0.04, 0.12)},
            {"Hz", r.between(100, 200)},
            {"damping", 0.05},
            {"share", r.between(0.3, 0.55)},
            {"load_friction", r.one<double>({0, 0, 0.4})}};
  if (kind == "presliding") return {{"sigma0", r.between(50, 120)}, {"sigma1", r.between(0.4, 0.7)}};
  if (kind == "input_delay") return {{"s", r.between(0.0015, 0.0045)}};
  if (kind == "current_loop_lag") return {{"Hz", r.between(40, 90)}};
  if (kind == "current_saturation") return {{"A", r.between(13, 19)}};
  if (kind == "dac_dead_zone") return {{"V", r.between(0.05, 0.12)}};
  if (kind == "viscous_asymmetry") return {{"part", r.either(0.2, 0.4)}};
  if (kind == "coulomb_asymmetry") return {{"part", r.either(0.08, 0.18)}};
  if (kind == "constant_torque") return {{"Nm", r.either(0.3, 0.7)}};
  if (kind == "dac_offset") return {{"V", r.either(0.06, 0.15)}};
  if (kind == "tach_gain") return {{"gain", 1 + r.either(0.02, 0.05)}};
  if (kind == "tach_offset") return {{"offset", r.either(0.3, 0.7)}};
  if (kind == "tach_lag") return {{"Hz", r.between(45, 90)}};
  if (kind == "tach_ripple") return {{"size", r.between(0.025, 0.045)}, {"order", r.one<double>({2, 4})}};
  if (kind == "encoder_cyclic_error")
    return {{"size", r.between(0.007, 0.014)}, {"period", r.one<double>({1.25, 2.5})}, {"phase", phase}};
  if (kind == "thermal_friction_drift")
    return {{"wet", -r.between(0.3, 0.55)}, {"dry", -r.between(0.15, 0.3)}, {"tau", r.between(7, 20)}};
  if (kind == "friction_lag") return {{"tau", r.between(0.015, 0.03)}};
  if (kind == "dwell_stiction") return {{"gain", r.between(0.35, 0.7)}, {"tau", r.between(0.5, 1.3)}};
  if (kind == "stribeck") return {{"extra", r.between(0.25, 0.5)}, {"fade", r.between(2, 5)}};
  if (kind == "nonlinear_viscous") return {{"size", r.between(0.02, 0.05)}, {"exponent", 2}};
  if (kind == "load_dependent_friction") return {{"part", r.between(0.05, 0.12)}};
  if (kind == "spring_torque") return {{"k", r.between(0.003, 0.008)}, {"centre", r.between(-20, 20)}};
  std::abort();
}

const std::vector<std::vector<string>> kGroups{{"constant_torque", "coulomb_asymmetry", "dac_offset"},
                                               {"dac_dead_zone", "load_dependent_friction"},
                                               {"backlash", "compliance", "presliding"},
                                               {"current_loop_lag", "input_delay"}};
const std::vector<string> kKinds{"cogging",
                                 "torque_ripple",
                                 "position_dependent_friction",
                                 "compliance",
                                 "backlash",
                                 "presliding",
                                 "input_delay",
                                 "current_loop_lag",
                                 "current_saturation",
                                 "dac_dead_zone",
                                 "viscous_asymmetry",
                                 "coulomb_asymmetry",
                                 "constant_torque",
                                 "dac_offset",
                                 "tach_gain",
                                 "tach_offset",
                                 "tach_lag",
                                 "tach_ripple",
                                 "encoder_cyclic_error",
                                 "thermal_friction_drift",
                                 "friction_lag",
                                 "dwell_stiction",
                                 "stribeck",
                                 "nonlinear_viscous",
                                 "load_dependent_friction",
                                 "spring_torque"};

bool excludes(const string& a, const string& b) {
  if (a == b) return true;
  for (const auto& group : kGroups)
    if (std::count(group.begin(), group.end(), a) && std::count(group.begin(), group.end(), b)) return true;
  const auto pair = [&](const char* one, const char* other) {
    return (a == one && b == other) || (a == other && b == one);
  };
  // A constant force only shifts the centre of a spring.
  if (pair("spring_torque", "constant_torque") || pair("spring_torque", "dac_offset")) return true;
  return pair("presliding", "friction_lag") || pair("presliding", "dwell_stiction") || pair("presliding", "stribeck") ||
         pair("stribeck", "friction_lag") || pair("stribeck", "dwell_stiction") ||
         pair("friction_lag", "dwell_stiction");
}

int main(int argc, char** argv) {
  if (argc != 5 && argc != 6)
    return std::fprintf(stderr, "made_machines SEED COUNT EFFECTS DIRECTORY [FIRST CASE]\n"), 2;
  const std::uint64_t seed = std::stoull(argv[1]);
  const int first_case = argc == 6 ? std::stoi(argv[5]) : 0;
  for (int n = first_case; n < first_case + std::stoi(argv[2]); ++n) {
    Random r{std::mt19937_64(seed * 1000 + static_cast<std::uint64_t>(n))};
    Drive d{};
    d.amplifier = r.between(6.2, 7.8);
    d.tach_variance = r.between(0.006, 0.02);
    d.inertia = r.between(0.0055, 0.0095);
    d.viscous = r.between(0.02, 0.038);
    d.forward = r.between(1.8, 3.2);
    const bool two_levels = r.between(0, 1) < 0.4;
    d.backward = two_levels ? d.forward * r.between(0.8, 1.1) : d.forward;
    const bool curved = r.between(0, 1) < 0.5;
    std::vector<string> kinds;
    while (kinds.size() < static_cast<std::size_t>(std::stoi(argv[3]))) {
      const string kind = r.one(kKinds);
      if (std::none_of(kinds.begin(), kinds.end(), [&](const string& other) { return excludes(kind, other); }))
        kinds.push_back(kind);
    }
    const auto hides = [&](const char* kind) { return std::count(kinds.begin(), kinds.end(), kind) > 0; };
    if ((curved || hides("friction_lag") || hides("dwell_stiction")) && !hides("stribeck"))
      d.extra = r.between(0.25, 0.5), d.fade = r.between(2, 5);
    // Two levels in the given model would absorb a force of constant sign, so then it has a single level.
    const bool one_level = hides("coulomb_asymmetry") || hides("constant_torque") || hides("dac_offset");
    if (one_level) d.backward = d.forward;
    for (const string& kind : kinds) d.hidden[kind] = sizes(kind, r);

    const string folder = string(argv[4]) + "/case-" + (n < 10 ? "0" : "") + std::to_string(n);
    std::filesystem::create_directories(folder);
    const std::uint64_t noise = r.engine();
    const auto none = [](int) { return 0.0; };
    for (const string name : {"train-steps", "train-jog", "train-sweep", "validate"}) {
      const int rows = name == "train-jog"     ? 29000
                       : name == "train-steps" ? 10000
                       : name == "train-sweep" ? 12000
                                               : 14000;
      Control control;
      if (name == "train-steps") {
        auto volts = std::make_shared<std::pair<double, int>>(0.0, 0);
        auto draw = std::make_shared<Random>(r);
        r.engine.discard(100);
        control = [=](int k, double x, double) {
          if (k >= volts->second) {
            const double least = (d.forward + d.backward) * 0.65 / d.amplifier / d.torque_constant;
            const double away = x > 60 ? -1 : x < -60 ? 1 : draw->between(0, 1) < 0.5 ? -1 : 1;
            *volts = {draw->between(0, 1) < 0.2 ? 0.0 : away * draw->between(least, least + 1.6),
                      k + static_cast<int>(draw->between(80, 400))};
          }
          return volts->first;
        };
      } else {
        std::vector<double> path(200, 0.0);
        if (name == "train-jog") path = jog_path(r, rows);
        while (path.size() < static_cast<std::size_t>(rows))
          move_to(path, r.between(-70, 70), name == "validate" ? r.between(20, 220) : r.between(60, 250),
                  name == "validate" ? r.between(0.02, 0.8) : 0.02);
        std::vector<std::pair<double, double>> waves;
        if (name == "train-sweep")
          for (double hertz = 2.3; hertz < 120; hertz *= 1.23) waves.emplace_back(hertz, r.between(0, 2 * kPi));
        control = follow(
            d, path, waves.empty() ? std::function<double(int)>(none) : [waves](int k) {
              double sum = 0;
              for (const auto& [hertz, phase] : waves) sum += 0.09 * std::sin(2 * kPi * hertz * k * kRow_s + phase);
              return sum;
            });
      }
      write(folder + "/" + name + ".csv", run(d, noise + name.size(), rows, control));
    }
    std::ofstream model(folder + "/model.toml");
    model << "format = \"axis-model/1\"\nname = \"made\"\n[drive]\nkind = \"rotary\"\namplifier_gain_A_per_V = "
          << d.amplifier
          << "\ntorque_constant_Nm_per_A = 0.4769\nlead_mm_per_rad = 1.5915494309189535\nsample_period_s = "
             "0.001\n[drive.dac]\n"
             "resolution_V = 0.00030517578125\nlimit_V = 10.0\n[drive.encoder]\nresolution_mm = "
             "0.00244140625\n[drive.tach]\n"
             "noise_variance_rad2_s2 = "
          << d.tach_variance << "\n[[effect]]\nkind = \"inertia\"\nJ_kg_m2 = " << d.inertia * r.between(0.98, 1.02)
          << "\n[[effect]]\nkind = \"viscous\"\nB_Nm_s_per_rad = " << d.viscous * r.between(0.95, 1.05)
          << "\n[[effect]]\nkind = \"coulomb\"\n";
    const double f = d.forward * r.between(0.97, 1.03),
                 b = two_levels && !one_level ? d.backward * r.between(0.97, 1.03) : f;
    if (f == b)
      model << "level_Nm = " << f << "\n";
    else
      model << "positive_Nm = " << f << "\nnegative_Nm = " << -b << "\n";
    if (d.extra > 0 && !hides("stribeck")) {
      const double grown = (1 + d.extra) * r.between(0.98, 1.02), fade = d.fade * r.between(0.95, 1.05);
      model << "[[effect]]\nkind = \"stribeck\"\n";
      if (f == b)
        model << "static_Nm = " << f * grown << "\nomega1_rad_s = " << fade << "\nomega2_rad_s = " << fade << "\n";
      else
        model << "static_positive_Nm = " << f * grown << "\nstatic_negative_Nm = " << -b * grown
              << "\nomega1_rad_s = " << fade << "\nomega2_rad_s = " << fade << "\n";
    }
    std::ofstream truth(folder + "/truth.json");
    truth << "{\"case\": " << n << ", \"seed\": " << seed << ", \"axis\": \"made\", \"effects\": [";
    for (std::size_t k = 0; k < kinds.size(); ++k) truth << (k ? ", " : "") << '"' << kinds[k] << '"';
    truth << "], \"parameters\": {";
    bool first = true;
    for (const auto& [kind, values] : d.hidden) {
      truth << (first ? "" : ", ") << '"' << kind << "\": {";
      first = false;
      bool one = true;
      for (const auto& [name, value] : values)
        truth << (one ? "" : ", ") << '"' << name << "\": " << value, one = false;
      truth << "}";
    }
    truth << "}, \"groups\": [";
    bool some = false;
    for (const auto& group : kGroups) {
      if (std::none_of(group.begin(), group.end(), [&](const string& kind) { return hides(kind.c_str()); })) continue;
      truth << (some ? ", [" : "[");
      some = true;
      for (std::size_t k = 0; k < group.size(); ++k) truth << (k ? ", " : "") << '"' << group[k] << '"';
      truth << "]";
    }
    truth << "]}\n";
  }
}
