#include "host/inner_products_kernel.hpp"

namespace host {

struct Avx;
template void inner_products<Avx>(const double* columns, std::size_t rows, std::size_t count, double* out);

}  // namespace host
