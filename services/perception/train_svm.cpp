// libsvm on a precomputed kernel: the matrix is computed once and serves all classes and folds.
#include "services/perception/train_svm.h"

#include <libsvm/svm.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace beckon::perception {
namespace {

using Kernel = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Kernel SquaredDistances(const std::vector<Features>& features) {
  const int n = static_cast<int>(features.size());
  Kernel x(n, static_cast<int>(features.front().size()));
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < x.cols(); ++j) {
      x(i, j) = static_cast<float>(features[static_cast<size_t>(i)][static_cast<size_t>(j)]) / 255;
    }
  }
  const Eigen::VectorXf norms = x.rowwise().squaredNorm();
  Kernel squared = -2 * x * x.transpose();
  squared.colwise() += norms;
  squared.rowwise() += norms.transpose();
  return squared.cwiseMax(0);
}

float MedianOf(const Kernel& squared) {
  std::vector<float> some;
  for (int i = 0; i < squared.rows(); i += 3) {
    for (int j = i % 7; j < squared.cols(); j += 7) some.push_back(squared(i, j));
  }
  const auto middle = some.begin() + static_cast<int64_t>(some.size() / 2);
  std::nth_element(some.begin(), middle, some.end());
  return std::max(1e-3F, *middle);
}

struct Machine {
  std::map<int, double> coefficients;  // by sample
  double rho = 0;
};

/// libsvm's view of the kernel matrix: one row a sample, led by its serial number.
class KernelRows {
 public:
  explicit KernelRows(const Kernel& kernel) : n_(static_cast<size_t>(kernel.rows())) {
    nodes_.resize(n_ * (n_ + 2));
    for (size_t i = 0; i < n_; ++i) {
      svm_node* row = Row(i);
      row[0] = {0, static_cast<double>(i + 1)};
      for (size_t j = 0; j < n_; ++j) {
        row[j + 1] = {static_cast<int>(j + 1),
                      static_cast<double>(kernel(static_cast<int>(i), static_cast<int>(j)))};
      }
      row[n_ + 1] = {-1, 0};
    }
  }
  svm_node* Row(size_t i) { return nodes_.data() + i * (n_ + 2); }

 private:
  size_t n_;
  std::vector<svm_node> nodes_;
};

/// The machine that tells `positive` from the others among `samples`.
Machine TrainOne(KernelRows& rows, const std::vector<int>& samples, const std::vector<int>& labels,
                 int positive, double cost) {
  std::vector<svm_node*> x;
  std::vector<double> y;
  double positives = 0;
  for (const int sample : samples) {
    x.push_back(rows.Row(static_cast<size_t>(sample)));
    y.push_back(labels[static_cast<size_t>(sample)] == positive ? 1 : -1);
    positives += y.back() > 0;
  }
  svm_problem problem{static_cast<int>(x.size()), y.data(), x.data()};
  int weight_labels[] = {1, -1};
  // Half way (in logarithm) between equal weights a sample and equal weights a class.
  double weights[] = {
      std::sqrt((static_cast<double>(x.size()) - positives) / std::max(1.0, positives)), 1};
  svm_parameter parameter{};
  parameter.svm_type = C_SVC;
  parameter.kernel_type = PRECOMPUTED;
  parameter.C = cost;
  parameter.eps = 1e-3;
  parameter.cache_size = 200;
  parameter.shrinking = 1;
  parameter.nr_weight = 2;
  parameter.weight_label = weight_labels;
  parameter.weight = weights;
  svm_model* model = svm_train(&problem, &parameter);
  Machine machine;
  // libsvm's positive class is the label it met first.
  const double sign = model->label[0] == 1 ? 1 : -1;
  machine.rho = sign * model->rho[0];
  for (int i = 0; i < model->l; ++i) {
    const int sample = static_cast<int>(model->SV[i][0].value) - 1;
    machine.coefficients[sample] = sign * model->sv_coef[0][i];
  }
  svm_free_and_destroy_model(&model);
  return machine;
}

double Decide(const Machine& machine, const Kernel& kernel, int sample) {
  double sum = -machine.rho;
  for (const auto& [support, coefficient] : machine.coefficients) {
    sum += coefficient * static_cast<double>(kernel(sample, support));
  }
  return sum;
}

SvmClassifier Assemble(const std::vector<Machine>& machines,
                       const std::vector<Features>& features) {
  std::map<int, int> columns;  // sample -> row of vectors
  for (const Machine& machine : machines) {
    for (const auto& entry : machine.coefficients) columns[entry.first] = 0;
  }
  int next = 0;
  for (auto& entry : columns) entry.second = next++;
  SvmClassifier out;
  out.vectors.resize(next, static_cast<int>(features.front().size()));
  out.coefficients.setZero(static_cast<int>(machines.size()), next);
  for (const auto& [sample, row] : columns) {
    for (int j = 0; j < out.vectors.cols(); ++j) {
      out.vectors(row, j) = features[static_cast<size_t>(sample)][static_cast<size_t>(j)];
    }
  }
  for (size_t c = 0; c < machines.size(); ++c) {
    out.rho.push_back(static_cast<float>(machines[c].rho));
    for (const auto& [sample, coefficient] : machines[c].coefficients) {
      out.coefficients(static_cast<int>(c), columns[sample]) = static_cast<float>(coefficient);
    }
  }
  return out;
}

}  // namespace

std::optional<TrainedSvm> TrainSvm(const SvmTrainingSet& set, const SvmTrainingConfig& config,
                                   const StepProgress& done) {
  svm_set_print_string_function([](const char*) {});
  Kernel kernel = SquaredDistances(set.features);
  const float gamma = static_cast<float>(config.gamma_scale) / MedianOf(kernel);
  kernel = (-gamma * kernel.array()).exp();
  KernelRows rows(kernel);
  const int n = static_cast<int>(set.features.size());

  // Row 0 of the tasks is everything, row f + 1 everything but fold f.
  std::vector<Machine> final_machines(static_cast<size_t>(set.classes));
  Eigen::MatrixXf decisions(set.classes, n);
  const auto train = [&](size_t task) {
    const int fold = static_cast<int>(task) / set.classes - 1;
    const int c = static_cast<int>(task) % set.classes;
    std::vector<int> inside;
    for (int i = 0; i < n; ++i) {
      if (set.folds[static_cast<size_t>(i)] != fold) inside.push_back(i);
    }
    Machine machine = TrainOne(rows, inside, set.labels, c, config.cost);
    for (int i = 0; i < n; ++i) {
      if (set.folds[static_cast<size_t>(i)] != fold) continue;
      decisions(c, i) = static_cast<float>(Decide(machine, kernel, i));
    }
    if (fold < 0) final_machines[static_cast<size_t>(c)] = std::move(machine);
  };
  const auto tasks = static_cast<size_t>((set.fold_count + 1) * set.classes);
  if (!ParallelFor(tasks, config.threads, train, done)) return std::nullopt;

  TrainedSvm out;
  out.classifier = Assemble(final_machines, set.features);
  out.classifier.gamma = gamma;
  for (int c = 0; c < set.classes; ++c) {
    std::vector<double> f;
    std::vector<bool> positive;
    for (int i = 0; i < n; ++i) {
      f.push_back(decisions(c, i));
      positive.push_back(set.labels[static_cast<size_t>(i)] == c);
    }
    out.classifier.sigmoids.push_back(FitSigmoid(f, positive));
  }
  out.classifier.Prepare();
  for (int i = 0; i < n; ++i) {
    out.out_of_fold.push_back(Couple(out.classifier.sigmoids, decisions.col(i)));
  }
  return out;
}

}  // namespace beckon::perception
