// Inner products of columns, four rows at once. Included by one file for each set of processor instructions.
#pragma once

#include <cstddef>
#include <cstring>

namespace host {

/// Four numbers, one operation of a processor with AVX and two of any other: the results are equal to the bit.
using FourNumbers [[gnu::vector_size(32)]] = double;

/// out(i, j) = column i . column j, both triangles. `columns`: `rows` x `count`, `out`: `count` x `count`, both by
/// columns. `Processor` makes the instances of different files different functions.
template <typename Processor>
void inner_products(const double* columns, std::size_t rows, std::size_t count, double* out) {
  constexpr std::size_t kLeft = 4, kRight = 2;  // columns of a block: eight sums stay in registers
  constexpr std::size_t kRows = 512;            // their rows stay in the first cache
  std::memset(out, 0, count * count * sizeof(double));
  for (std::size_t top = 0; top < rows; top += kRows) {
    const std::size_t bottom = rows - top < kRows ? rows : top + kRows;
    for (std::size_t j = 0; j < count; j += kRight)
      for (std::size_t i = j; i < count; i += kLeft) {
        const double *left[kLeft], *right[kRight];
        for (std::size_t k = 0; k < kLeft; ++k) left[k] = columns + rows * (i + k < count ? i + k : count - 1);
        for (std::size_t k = 0; k < kRight; ++k) right[k] = columns + rows * (j + k < count ? j + k : count - 1);
        FourNumbers sums[kLeft][kRight] = {};
        std::size_t row = top;
        for (; row + 4 <= bottom; row += 4) {
          FourNumbers a[kLeft], b[kRight];
#pragma GCC unroll 4
          for (std::size_t k = 0; k < kLeft; ++k) std::memcpy(&a[k], left[k] + row, sizeof(FourNumbers));
#pragma GCC unroll 4
          for (std::size_t k = 0; k < kRight; ++k) std::memcpy(&b[k], right[k] + row, sizeof(FourNumbers));
#pragma GCC unroll 4
          for (std::size_t m = 0; m < kLeft; ++m)
#pragma GCC unroll 2
            for (std::size_t k = 0; k < kRight; ++k) sums[m][k] += a[m] * b[k];
        }
        for (std::size_t m = 0; m < kLeft && i + m < count; ++m)
          for (std::size_t k = 0; k < kRight && j + k < count; ++k) {
            const FourNumbers& four = sums[m][k];
            double sum = (four[0] + four[1]) + (four[2] + four[3]);
            for (std::size_t last = row; last < bottom; ++last) sum += left[m][last] * right[k][last];
            out[(j + k) * count + i + m] += sum;
          }
      }
  }
  for (std::size_t j = 0; j < count; ++j)
    for (std::size_t i = 0; i < j; ++i) out[j * count + i] = out[i * count + j];
}

}  // namespace host
