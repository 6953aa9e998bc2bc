// k-means and nearest words.
#include "services/perception/bag_of_words.h"

#include <algorithm>
#include <vector>

namespace beckon::perception {
namespace {

/// The nearest row of `vocabulary` of each descriptor.
std::vector<int> NearestWords(const Descriptors& vocabulary, const Descriptors& descriptors) {
  constexpr int kBlock = 1024;  // rows at a time, to bound the product's memory
  const Eigen::RowVectorXf norms = vocabulary.rowwise().squaredNorm().transpose();
  std::vector<int> nearest(static_cast<size_t>(descriptors.rows()));
  for (int start = 0; start < descriptors.rows(); start += kBlock) {
    const int rows = std::min<int>(kBlock, static_cast<int>(descriptors.rows()) - start);
    Descriptors distances = -2 * descriptors.middleRows(start, rows) * vocabulary.transpose();
    distances.rowwise() += norms;
    for (int i = 0; i < rows; ++i) {
      distances.row(i).minCoeff(&nearest[static_cast<size_t>(start + i)]);
    }
  }
  return nearest;
}

/// k-means++ (Arthur and Vassilvitskii 2007).
Descriptors Seed(const Descriptors& samples, int words, std::mt19937& random) {
  Descriptors centres(words, samples.cols());
  Eigen::VectorXf distances = Eigen::VectorXf::Constant(samples.rows(), 1e30F);
  int64_t pick = static_cast<int64_t>(random() % static_cast<uint64_t>(samples.rows()));
  for (int word = 0; word < words; ++word) {
    centres.row(word) = samples.row(pick);
    distances = distances.cwiseMin((samples.rowwise() - centres.row(word)).rowwise().squaredNorm());
    const double total = distances.cast<double>().sum();
    double left = total * (static_cast<double>(random()) / 4294967296.0);
    pick = 0;
    while (pick + 1 < samples.rows() && (left -= distances[pick]) > 0) ++pick;
  }
  return centres;
}

}  // namespace

Descriptors LearnVocabulary(const Descriptors& samples, int words, int iterations,
                            std::mt19937& random) {
  words = std::min<int>(words, static_cast<int>(samples.rows()));
  if (words == 0) return Descriptors(0, samples.cols());
  Descriptors centres = Seed(samples, words, random);
  for (int iteration = 0; iteration < iterations; ++iteration) {
    const std::vector<int> nearest = NearestWords(centres, samples);
    Descriptors sums = Descriptors::Zero(words, samples.cols());
    Eigen::VectorXf counts = Eigen::VectorXf::Zero(words);
    for (int i = 0; i < samples.rows(); ++i) {
      sums.row(nearest[static_cast<size_t>(i)]) += samples.row(i);
      ++counts[nearest[static_cast<size_t>(i)]];
    }
    for (int word = 0; word < words; ++word) {
      if (counts[word] > 0) centres.row(word) = sums.row(word) / counts[word];
    }
  }
  return centres;
}

Eigen::RowVectorXf BagOfWords(const Descriptors& vocabulary, const Descriptors& descriptors) {
  Eigen::RowVectorXf bag = Eigen::RowVectorXf::Zero(vocabulary.rows());
  if (descriptors.rows() == 0 || vocabulary.rows() == 0) return bag;
  for (const int word : NearestWords(vocabulary, descriptors)) ++bag[word];
  return (bag / static_cast<float>(descriptors.rows())).cwiseSqrt();
}

}  // namespace beckon::perception
