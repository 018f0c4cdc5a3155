// Image that counts the instructions of other implementations of the estimator: Eigen, and general matrix functions.
#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "firmware/boards/image/fault_handler.hpp"
#include "tests/firmware/paper_axes.hpp"
#include "tests/target/images/instruction_counter.hpp"

namespace firmware::boards {
void make_outputs_safe() noexcept {}
}  // namespace firmware::boards

extern "C" void control_interrupt() {}

namespace {

using namespace target_image;

constexpr auto kParameters = firmware_test::parameters_of<float>(firmware_test::kPaperX);

/// x <- A x + B u, x <- x + K (z - C x), u = Kc (r - x) in Eigen's fixed-size types.
struct EigenLoop {
  Eigen::Matrix3f A;
  Eigen::Vector3f B, x = Eigen::Vector3f::Zero();
  Eigen::Matrix<float, 3, 2> K;
  Eigen::Matrix<float, 2, 3> C;
  Eigen::RowVector3f Kc;
  float u = 0.0f;

  EigenLoop() {
    const auto& p = kParameters;
    A << 1.0f, p.drive.Ad12, -p.drive.Bd1, 0.0f, p.drive.Ad22, -p.drive.Bd2, 0.0f, 0.0f, 1.0f;
    B << p.drive.Bd1, p.drive.Bd2, 0.0f;
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 2; ++column) K(row, column) = p.Kobs[row][column];
    C << 1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f;
    Kc << p.Kc[0], p.Kc[1], 0.0f;
  }

  [[gnu::noinline]] void step(const Eigen::Vector2f& z, const Eigen::Vector3f& r) {
    x = A * x + B * u;
    x += K * (z - C * x);
    u = Kc.dot(r - x);
  }
};

/// A matrix of any size, row by row, and functions over it: the interface of the usual signal-processing libraries.
struct Matrix {
  std::uint16_t rows, columns;
  float* data;
};

[[gnu::noinline]] void multiply(const Matrix& a, const Matrix& b, const Matrix& result) {
  for (std::uint16_t i = 0; i < a.rows; ++i)
    for (std::uint16_t j = 0; j < b.columns; ++j) {
      float sum = 0.0f;
      for (std::uint16_t k = 0; k < a.columns; ++k) sum += a.data[i * a.columns + k] * b.data[k * b.columns + j];
      result.data[i * b.columns + j] = sum;
    }
}

[[gnu::noinline]] void add_scaled(const Matrix& a, const Matrix& b, float scale, const Matrix& result) {
  for (int i = 0; i < a.rows * a.columns; ++i) result.data[i] = a.data[i] + scale * b.data[i];
}

struct GeneralLoop {
  std::array<float, 9> A_data;
  std::array<float, 3> B_data, x_data{}, r_data{}, ax_data{}, bu_data{}, kz_data{};
  std::array<float, 6> K_data, C_data{1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f};
  std::array<float, 2> z_data{}, cx_data{};
  std::array<float, 3> Kc_data;
  float u = 0.0f;

  GeneralLoop() {
    const auto& p = kParameters;
    A_data = {1.0f, p.drive.Ad12, -p.drive.Bd1, 0.0f, p.drive.Ad22, -p.drive.Bd2, 0.0f, 0.0f, 1.0f};
    B_data = {p.drive.Bd1, p.drive.Bd2, 0.0f};
    for (std::size_t row = 0; row < 3; ++row)
      for (std::size_t column = 0; column < 2; ++column) K_data[row * 2 + column] = p.Kobs[row][column];
    Kc_data = {p.Kc[0], p.Kc[1], 0.0f};
  }

  [[gnu::noinline]] void step(float position, float velocity) {
    const Matrix A{3, 3, A_data.data()}, B{3, 1, B_data.data()}, K{3, 2, K_data.data()}, C{2, 3, C_data.data()};
    const Matrix x{3, 1, x_data.data()}, Ax{3, 1, ax_data.data()}, Bu{3, 1, bu_data.data()}, z{2, 1, z_data.data()};
    const Matrix Cx{2, 1, cx_data.data()}, Kz{3, 1, kz_data.data()}, Kc{1, 3, Kc_data.data()}, r{3, 1, r_data.data()};
    const Matrix input{1, 1, &u};
    z_data = {position, velocity};
    multiply(A, x, Ax);
    multiply(B, input, Bu);
    add_scaled(Ax, Bu, 1.0f, x);
    multiply(C, x, Cx);
    add_scaled(z, Cx, -1.0f, z);
    multiply(K, z, Kz);
    add_scaled(x, Kz, 1.0f, x);
    add_scaled(r, x, -1.0f, Kz);
    multiply(Kc, Kz, input);
  }
};

template <typename Step>
void count_many(const char* name, Step step) {
  Cost cost;
  for (int k = 0; k < 1000; ++k) cost.add(count([&] { step(static_cast<float>(k % 7) * 0.001f); }));
  report(name, cost);
}

EigenLoop eigen_loop;
GeneralLoop general_loop;

}  // namespace

extern "C" [[noreturn]] void run_board() {
  firmware::boards::arm_fault_detection();
  start_counting();
  const Eigen::Vector3f r = Eigen::Vector3f::Zero();
  count_many("eigen", [&r](float z) { eigen_loop.step(Eigen::Vector2f(z, z), r); });
  count_many("general_matrices", [](float z) { general_loop.step(z, z); });
  hal::qemu::exit_emulator(0);
}
