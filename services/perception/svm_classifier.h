// Evaluation of one-against-all RBF support vector machines with Platt's probabilities.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "services/perception/cue_encoder.h"

namespace beckon::perception {

/// Platt's sigmoid (1999): P(positive | f) = 1 / (1 + exp(a f + b)).
struct Sigmoid {
  float a = -1;
  float b = 0;

  double Probability(double decision) const;
};

/// One machine a class over shared support vectors x_s:
/// f_c(x) = sum_s coefficients(c, s) exp(-gamma |x - x_s|^2) - rho_c, with features in 0..1.
struct SvmClassifier {
  float gamma = 1;
  Eigen::Matrix<uint8_t, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> vectors;  // one a row
  Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>
      coefficients;               // class x vector
  std::vector<float> rho;         // one a class
  std::vector<Sigmoid> sigmoids;  // one a class

  int classes() const { return static_cast<int>(rho.size()); }
  int dimension() const { return static_cast<int>(vectors.cols()); }

  /// To be called after the fields were filled in: prepares what Decide needs.
  void Prepare();
  /// Decision values, one a class; `features` of length dimension().
  Eigen::VectorXf Decide(const Features& features) const;
  /// Sum 1.
  std::vector<float> Probabilities(const Features& features) const;

 private:
  Eigen::MatrixXf floats_;  // dimension x vectors, scaled to 0..1
  Eigen::VectorXf norms_;   // squared, of each
};

/// Each class's own probability from its decision value, scaled to sum 1.
std::vector<float> Couple(const std::vector<Sigmoid>& sigmoids, const Eigen::VectorXf& decisions);

}  // namespace beckon::perception
