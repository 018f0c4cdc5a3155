// axis_pil: the processor-in-the-loop runs, as a table. Exit status 1 if a bit differs, 77 if nothing can be run.
//   axis_pil [IMAGE...]    runs those images only (default: all)
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <functional>

#include "tests/target/pil/links.hpp"

namespace {

using target_test::FileLink;
using target_test::first_difference;
using target_test::hash;
using target_test::obstacle;
using target_test::Replies;
using target_test::run_on_host;
using target_test::run_over;
using target_test::SerialLink;

bool all_equal = true;

void print_row(const std::string& image_name, const char* link, int repetition, const Replies& expected,
               const std::function<Replies()>& run_board) {
  const auto start = std::chrono::steady_clock::now();
  const Replies seen = run_board();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  const std::string difference = first_difference(expected, seen);
  all_equal = all_equal && difference.empty();
  fmt::print("{:<20} {:<7} {:>3}  {:>8}  {:016x}  {:016x}  {:>6.1f} s  {}\n", image_name, link, repetition, seen.size(),
             hash(expected), hash(seen), took.count(), difference.empty() ? "equal" : difference);
  std::fflush(stdout);
}

template <typename Scalar>
void run_image(const std::string& image_name, bool serial_too) {
  const Replies expected = run_on_host<Scalar>();
  for (int repetition = 1; repetition <= 3; ++repetition)
    print_row(image_name, "files", repetition, expected, [&] {
      FileLink link(image_name);
      Replies seen = run_over<Scalar>(link);
      link.finish();
      return seen;
    });
  if (!serial_too) return;
  print_row(image_name, "serial", 1, expected, [&] {
    SerialLink link(image_name);
    Replies seen = run_over<Scalar>(link);
    link.finish();
    return seen;
  });
}

struct Image {
  const char* name;
  void (*run)(const std::string&, bool);
  bool serial_too;
};
constexpr Image kImages[] = {{"qemu-f405", run_image<float>, true},
                             {"qemu-f405-fixed", run_image<firmware::FixedPoint>, false},
                             {"qemu-f405-fixed-m3", run_image<firmware::FixedPoint>, false},
                             {"qemu-f405-fixed-m0plus", run_image<firmware::FixedPoint>, false}};

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> wanted(argv + 1, argv + argc);
  fmt::print("10 s of motion, two axes at 1 kHz: every D/A word and every state, image against host build\n");
  fmt::print("{:<20} {:<7} {:>3}  {:>8}  {:<16}  {:<16}  {:>8}\n", "image", "link", "run", "periods", "host's hash",
             "image's hash", "took");
  for (const Image& image : kImages) {
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), image.name) == wanted.end()) continue;
    const std::string why = obstacle(image.name);
    if (!why.empty()) {
      fmt::print(stderr, "{}: {}\n", image.name, why);
      return 77;
    }
    try {
      image.run(image.name, image.serial_too);
    } catch (const std::exception& error) {
      fmt::print(stderr, "{}: {}\n", image.name, error.what());
      return 1;
    }
  }
  return all_equal ? 0 : 1;
}
