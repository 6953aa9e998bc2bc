// Kernel sums and sigmoids.
#include "services/perception/svm_classifier.h"

#include <algorithm>
#include <cmath>

namespace beckon::perception {
namespace {

Eigen::VectorXf ToFloats(const uint8_t* bytes, int64_t count) {
  return Eigen::Map<const Eigen::Matrix<uint8_t, Eigen::Dynamic, 1>>(bytes, count).cast<float>() /
         255.0F;
}

}  // namespace

double Sigmoid::Probability(double decision) const {
  const double x = a * decision + b;
  return x >= 0 ? std::exp(-x) / (1 + std::exp(-x)) : 1 / (1 + std::exp(x));
}

void SvmClassifier::Prepare() {
  if (classes() == 0) return;
  floats_.resize(vectors.cols(), vectors.rows());
  for (int i = 0; i < vectors.rows(); ++i) {
    floats_.col(i) = ToFloats(vectors.row(i).data(), vectors.cols());
  }
  norms_ = floats_.colwise().squaredNorm().transpose();
}

Eigen::VectorXf SvmClassifier::Decide(const Features& features) const {
  const Eigen::VectorXf x = ToFloats(features.data(), static_cast<int64_t>(features.size()));
  Eigen::VectorXf kernel = norms_ - 2 * (floats_.transpose() * x);
  kernel = (-gamma * (kernel.array() + x.squaredNorm()).max(0.0F)).exp();
  return coefficients * kernel - Eigen::Map<const Eigen::VectorXf>(rho.data(), classes());
}

std::vector<float> SvmClassifier::Probabilities(const Features& features) const {
  return Couple(sigmoids, Decide(features));
}

std::vector<float> Couple(const std::vector<Sigmoid>& sigmoids, const Eigen::VectorXf& decisions) {
  std::vector<double> p(sigmoids.size());
  double sum = 0;
  for (size_t c = 0; c < p.size(); ++c) {
    p[c] = std::max(1e-7, sigmoids[c].Probability(decisions[static_cast<int>(c)]));
    sum += p[c];
  }
  std::vector<float> out(p.size());
  for (size_t c = 0; c < p.size(); ++c) out[c] = static_cast<float>(p[c] / sum);
  return out;
}

}  // namespace beckon::perception
