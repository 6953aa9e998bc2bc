#include "bench/speech/fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace beckon::bench {
namespace {

using ui_bridge::speech::Features;
using ui_bridge::speech::JudgementModel;
using ui_bridge::speech::kFeatures;

constexpr int kSteps = 40;
constexpr double kStep = 0.6;  // damped
constexpr int kSize = kFeatures + 1;
using Vector = Eigen::Matrix<double, kSize, 1>;
using Matrix = Eigen::Matrix<double, kSize, kSize>;

struct Scale {
  Features mean{};
  Features deviation{};

  explicit Scale(const std::vector<Example>& examples) {
    double n = 0;
    for (const auto& example : examples) {
      for (const auto& features : example.commands) {
        ++n;
        for (size_t i = 0; i < kFeatures; ++i) {
          mean[i] += features[i];
          deviation[i] += features[i] * features[i];
        }
      }
    }
    for (size_t i = 0; i < kFeatures; ++i) {
      mean[i] /= std::max(1.0, n);
      deviation[i] = std::sqrt(std::max(1e-8, deviation[i] / std::max(1.0, n) - mean[i] * mean[i]));
    }
  }

  Vector Standard(const Features& features) const {
    Vector x;
    for (size_t i = 0; i < kFeatures; ++i)
      x(static_cast<int>(i)) = (features[i] - mean[i]) / deviation[i];
    x(kFeatures) = 1;
    return x;
  }
};

/// Adds an utterance's part of the log-likelihood's gradient and negative Hessian.
void Accumulate(const Example& example, const Scale& scale, const Vector& w, double weight,
                Vector& gradient, Matrix& hessian) {
  std::vector<Vector> x;
  std::vector<double> odds;
  double sum = 1;
  for (const auto& features : example.commands) {
    x.push_back(scale.Standard(features));
    odds.push_back(std::exp(std::clamp(w.dot(x.back()), -30.0, 30.0)));
    sum += odds.back();
  }
  Vector mean = Vector::Zero();
  for (size_t i = 0; i < x.size(); ++i) {
    const double p = odds[i] / sum;
    mean += p * x[i];
    hessian += weight * p * x[i] * x[i].transpose();
  }
  hessian -= weight * mean * mean.transpose();
  gradient -= weight * mean;
  if (example.said) gradient += weight * x[*example.said];
}

}  // namespace

JudgementModel Fit(const std::vector<Example>& examples, double ridge) {
  const Scale scale(examples);
  const auto n = static_cast<double>(examples.size());
  const auto inside = static_cast<double>(
      std::ranges::count_if(examples, [](const Example& e) { return e.said.has_value(); }));
  Vector w = Vector::Zero();
  for (int step = 0; step < kSteps; ++step) {
    Vector gradient = -ridge * w;
    Matrix hessian = ridge * Matrix::Identity();
    for (const auto& example : examples) {
      const double share = example.said ? inside : n - inside;
      Accumulate(example, scale, w, n / 2 / std::max(1.0, share), gradient, hessian);
    }
    w += kStep * hessian.ldlt().solve(gradient);
  }
  JudgementModel model;
  model.bias = w(kFeatures);
  for (size_t i = 0; i < kFeatures; ++i) {
    model.weights[i] = w(static_cast<int>(i)) / scale.deviation[i];
    model.bias -= w(static_cast<int>(i)) * scale.mean[i] / scale.deviation[i];
  }
  return model;
}

}  // namespace beckon::bench
