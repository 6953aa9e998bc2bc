// A new category in a model that is there.
#include <algorithm>

#include "services/perception/model.h"

namespace beckon::perception {
namespace {

/// The matrix with a column of zeros at `at`.
template <typename Matrix>
Matrix WithColumn(const Matrix& matrix, int64_t at) {
  Matrix out = Matrix::Zero(matrix.rows(), matrix.cols() + 1);
  out.leftCols(at) = matrix.leftCols(at);
  out.rightCols(matrix.cols() - at) = matrix.rightCols(matrix.cols() - at);
  return out;
}

/// A machine for the new class that never fires.
void AddClass(size_t at, SvmClassifier& svm) {
  const Sigmoid never{0, 50};
  decltype(svm.coefficients)::PlainObject turned = svm.coefficients.transpose();
  svm.coefficients = WithColumn(turned, static_cast<int64_t>(at)).transpose();
  svm.rho.insert(svm.rho.begin() + static_cast<int64_t>(at), 0);
  svm.sigmoids.insert(svm.sigmoids.begin() + static_cast<int64_t>(at), never);
}

/// The new category's probability of each cue, which is 0 in what was learnt so far.
void AddFeatures(size_t at, size_t classes, size_t cues, SvmClassifier& svm) {
  for (size_t cue = cues; cue-- > 0;) {
    svm.vectors = WithColumn(svm.vectors, static_cast<int64_t>(cue * classes + at));
  }
}

}  // namespace

void AddCategory(const std::string& category, Model& model) {
  const auto place = std::lower_bound(model.categories.begin(), model.categories.end(), category);
  if (place != model.categories.end() && *place == category) return;
  const size_t classes = model.categories.size();
  const auto at = static_cast<size_t>(place - model.categories.begin());
  model.categories.insert(place, category);
  for (CueModel& cue : model.cues) {
    AddClass(at, cue.classifier);
    cue.classifier.Prepare();
  }
  for (Decider& decider : model.deciders) {
    for (SvmClassifier* svm : {&decider.svm, &decider.correction}) {
      if (svm->classes() == 0) continue;
      AddClass(at, *svm);
      AddFeatures(at, classes, decider.cues.size(), *svm);
      svm->Prepare();
    }
  }
}

}  // namespace beckon::perception
