// A vocabulary of visual words and the bag of words of a set of descriptors (Csurka et al. 2004).
#pragma once

#include <random>

#include "services/perception/cue_interface.h"

namespace beckon::perception {

/// Words by k-means (k-means++ start, Lloyd's iterations) over the rows of `samples`; fewer rows
/// than `words` give as many words as there are rows. Same samples and engine, same words.
Descriptors LearnVocabulary(const Descriptors& samples, int words, int iterations,
                            std::mt19937& random);

/// Square roots of the shares of each word (their Euclidean distance is Hellinger's); all zero
/// where there are no descriptors.
Eigen::RowVectorXf BagOfWords(const Descriptors& vocabulary, const Descriptors& descriptors);

}  // namespace beckon::perception
