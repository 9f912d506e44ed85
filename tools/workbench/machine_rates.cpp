// SPDX-License-Identifier: GPL-3.0-or-later
// Peak, product and stream of one core.
#include "tools/workbench/machine_rates.h"

#include <cstdint>
#include <vector>

#include "core/linalg/kernels.h"
#include "tools/workbench/shortest.h"

namespace insula {
namespace {

template <class Real>
double peak() {
  const KernelsOf<Real>& k = kernels_of<Real>();
  const long n = 100000;
  volatile Real sum = 0;
  const double s = shortest(20, [&] { sum = k.multiply_add(n); });
  return 48.0 * double(n) * k.width / s;
}

template <class Real>
double product() {
  const KernelsOf<Real>& k = kernels_of<Real>();
  constexpr int n = 192;  // a multiple of every tile; three matrices are 0.9 MB of doubles
  std::vector<Real> a(n * n + 64, Real(0.01)), b(a), c(a);
  const double s = shortest(40, [&] { k.gemm_sub(c.data(), n, a.data(), n, b.data(), n, n, n, n); });
  return 2.0 * n * n * n / s;
}

double stream() {
  std::vector<std::uint64_t> buffer(std::size_t(32) << 20, 1);  // 256 MB
  volatile std::uint64_t sum = 0;
  const double s = shortest(5, [&] {
    std::uint64_t part[8] = {};
    for (std::size_t i = 0; i < buffer.size(); i += 8)
      for (std::size_t q = 0; q < 8; ++q) part[q] += buffer[i + q];
    for (std::uint64_t p : part) sum = sum + p;
  });
  return 8.0 * double(buffer.size()) / s;
}

}  // namespace

MachineRates measure_machine() {
  return {peak<double>(), peak<float>(), product<double>(), product<float>(), stream()};
}

}  // namespace insula
