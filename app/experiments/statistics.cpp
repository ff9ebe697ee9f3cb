#include <barchan/app/experiments/statistics.hpp>

#include <algorithm>
#include <cmath>

namespace barchan::app {
namespace {

/// P(k of n values lie below their median).
std::vector<double> signs(std::size_t n) {
  std::vector<double> chance{1.0};
  for (std::size_t value = 0; value < n; ++value) {
    std::vector<double> longer(chance.size() + 1, 0.0);
    for (std::size_t k = 0; k < chance.size(); ++k) {
      longer[k] += 0.5 * chance[k];
      longer[k + 1] += 0.5 * chance[k];
    }
    chance = std::move(longer);
  }
  return chance;
}

/// P(U = u) of Mann and Whitney's count for n and m values: of all orders, those with u pairs in
/// which the second comes first.
std::vector<double> pair_counts(std::size_t n, std::size_t m) {
  // orders[j][u] of i values of one kind and j of the other; i grows.
  std::vector<std::vector<double>> orders(m + 1, std::vector<double>(n * m + 1, 0.0));
  for (auto& of_j : orders) of_j[0] = 1.0;
  for (std::size_t i = 1; i <= n; ++i) {
    for (std::size_t j = 1; j <= m; ++j) {
      // The last one is of the first kind (then j pairs with it), or of the second.
      std::vector<double> sum = orders[j - 1];
      for (std::size_t u = 0; u + j < sum.size(); ++u) sum[u + j] += orders[j][u];
      orders[j] = std::move(sum);
    }
  }
  double all = 0.0;
  for (const double count : orders[m]) all += count;
  for (double& count : orders[m]) count /= all;
  return orders[m];
}

/// The bounds among ordered estimates of which so many lie below the truth with these chances.
Interval bounded(std::vector<double> estimates, const std::vector<double>& chance,
                 double confidence) {
  Interval interval;
  interval.value = std::exp(median(estimates));
  interval.low = interval.high = interval.value;
  if (estimates.size() < 2) return interval;
  std::sort(estimates.begin(), estimates.end());
  std::size_t k = 0;
  double tail = chance[0];  // P(count <= k)
  while (2 * (k + 1) < estimates.size() && 1.0 - 2.0 * (tail + chance[k + 1]) >= confidence)
    tail += chance[++k];
  interval.low = std::exp(estimates[k]);
  interval.high = std::exp(estimates[estimates.size() - 1 - k]);
  interval.confidence = 1.0 - 2.0 * tail;
  return interval;
}

}  // namespace

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

double spread(const std::vector<double>& values) {
  if (values.size() < 2) return 0.0;
  const auto [lo, hi] = std::minmax_element(values.begin(), values.end());
  return (*hi - *lo) / median(values);
}

Interval paired_ratio(const std::vector<std::pair<double, double>>& pairs, double confidence) {
  std::vector<double> logs;
  for (const auto& [a, b] : pairs) logs.push_back(std::log(b / a));
  const std::vector<double> chance = signs(logs.size());
  return bounded(std::move(logs), chance, confidence);
}

Interval unpaired_ratio(const std::vector<double>& a, const std::vector<double>& b,
                        double confidence) {
  std::vector<double> differences;
  for (const double x : a) {
    for (const double y : b) differences.push_back(std::log(y / x));
  }
  return bounded(std::move(differences), pair_counts(a.size(), b.size()), confidence);
}

}  // namespace barchan::app
