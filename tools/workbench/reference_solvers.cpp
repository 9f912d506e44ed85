// SPDX-License-Identifier: GPL-3.0-or-later
// CHOLMOD and Eigen as solvers of one body.
#include "tools/workbench/reference_solvers.h"

#include <cholmod.h>
#include <dlfcn.h>

#include <Eigen/SparseCholesky>
#include <filesystem>
#include <stdexcept>

namespace insula {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

/// The scalar lower triangle of the blocks.
class Expanded {
 public:
  const Sparse& pattern(const BlockMatrix& a) {
    std::vector<Eigen::Triplet<double>> entries;
    each(a, [&](int row, int column, double) { entries.emplace_back(row, column, 0.0); });
    matrix_.resize(3 * a.nodes(), 3 * a.nodes());
    matrix_.setFromTriplets(entries.begin(), entries.end());
    return matrix_;
  }
  const Sparse& values(const BlockMatrix& a) {
    double* to = matrix_.valuePtr();
    each(a, [&](int, int, double v) { *to++ = v; });
    return matrix_;
  }
  Sparse& matrix() { return matrix_; }

 private:
  // Column by column, rows ascending: the order in which compressed columns are stored.
  template <class F>
  static void each(const BlockMatrix& a, F&& f) {
    for (int j = 0; j < a.nodes(); ++j)
      for (int c = 0; c < 3; ++c)
        for (int s = a.column_start(j); s < a.column_start(j + 1); ++s)
          for (int r = a.row(s) == j ? c : 0; r < 3; ++r) f(3 * a.row(s) + r, 3 * j + c, a.block(s)[3 * c + r]);
  }
  Sparse matrix_;
};

/// Everything but the factor: H^T as a dense matrix, X = A^-1 H^T, W = H X.
class ReferenceSolver : public ComplianceSolver {
 public:
  void solve(double* x) override {
    one_ = Eigen::Map<VecX>(x, size_);
    solve_columns(one_);
    Eigen::Map<VecX>(x, size_) = x_;
  }
  void begin_compliance(const BodyRows& rows, const std::vector<int>& node_of_block) override {
    const int m = rows.count();
    h_.setZero(size_, m);
    for (int r = 0; r < m; ++r)
      for (int e = rows.start[std::size_t(r)]; e < rows.start[std::size_t(r) + 1]; ++e)
        if (const int node = node_of_block[std::size_t(rows.block[std::size_t(e)])]; node >= 0)
          h_.block<3, 1>(3 * node, r) += rows.coeff[std::size_t(e)];
    columns_ = m;
    w_.setZero(m, m);
  }
  int compliance_parts(ComplianceAct) const override { return columns_ > 0 && size_ > 0 ? 1 : 0; }
  void compliance_part(ComplianceAct act, int) override {
    if (act == ComplianceAct::product) {
      w_.noalias() = h_.transpose() * solved_;
      return;
    }
    solve_columns(h_);
    solved_ = x_;
  }
  void add_compliance(const BodyRows& rows, double* w, int stride) override {
    for (int i = 0; i < columns_; ++i)
      for (int j = 0; j < columns_; ++j)
        w[std::size_t(rows.row[std::size_t(i)]) * std::size_t(stride) + std::size_t(rows.row[std::size_t(j)])] +=
            w_(i, j);
  }
  SolverCost cost() const override {
    SolverCost c;
    c.factor_entries = entries_;
    c.factor_flops = flops_;
    c.factor_bytes = 16.0 * double(entries_);
    return c;
  }

 protected:
  virtual void solve_columns(const MatX& b) = 0;  ///< into x_
  MatX x_;
  int size_ = 0;
  std::int64_t entries_ = 0;
  double flops_ = 0;

 private:
  MatX one_, h_, solved_, w_;
  int columns_ = 0;
};

/// CHOLMOD starts threads for loops of microseconds; here no parallel region becomes active while one of these lives.
class OneThread {
 public:
  OneThread() : set_(find<void(int)>("omp_set_max_active_levels")) {
    if (const auto get = find<int()>("omp_get_max_active_levels")) before_ = get();
    if (set_) set_(0);
    if (const auto blas = find<void(int)>("openblas_set_num_threads")) blas(1);
  }
  ~OneThread() {
    if (set_) set_(before_);
  }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  template <class F>
  static F* find(const char* name) {
    return reinterpret_cast<F*>(::dlsym(RTLD_DEFAULT, name));
  }
  void (*set_)(int);
  int before_ = 1;
};

class CholmodSolver final : public ReferenceSolver {
 public:
  CholmodSolver() {
    cholmod_start(&c_);
    c_.print = 0;
    c_.supernodal = CHOLMOD_SUPERNODAL;
  }
  ~CholmodSolver() override {
    release();
    cholmod_free_dense(&solution_, &c_);
    cholmod_free_dense(&work1_, &c_);
    cholmod_free_dense(&work2_, &c_);
    cholmod_finish(&c_);
  }
  CholmodSolver(const CholmodSolver&) = delete;
  CholmodSolver& operator=(const CholmodSolver&) = delete;

  void analyse(const BlockMatrix& a) override {
    release();
    size_ = 3 * a.nodes();
    expanded_.pattern(a);
    cholmod_sparse view = sparse_view();
    factor_ = cholmod_analyze(&view, &c_);
    if (!factor_) throw std::runtime_error("CHOLMOD's symbolic factorisation failed");
    flops_ = c_.fl;
    entries_ = std::int64_t(c_.lnz);
  }
  bool factorise(const BlockMatrix& a) override {
    const OneThread guard;
    expanded_.values(a);
    cholmod_sparse view = sparse_view();
    return cholmod_factorize(&view, factor_, &c_) && c_.status == CHOLMOD_OK;
  }

 private:
  void solve_columns(const MatX& b) override {
    const OneThread guard;
    cholmod_dense right{};
    right.nrow = right.d = std::size_t(b.rows());
    right.ncol = std::size_t(b.cols());
    right.nzmax = right.nrow * right.ncol;
    right.x = const_cast<double*>(b.data());
    right.xtype = CHOLMOD_REAL;
    right.dtype = CHOLMOD_DOUBLE;
    cholmod_solve2(CHOLMOD_A, factor_, &right, nullptr, &solution_, nullptr, &work1_, &work2_, &c_);
    x_ = Eigen::Map<const MatX>(static_cast<const double*>(solution_->x), b.rows(), b.cols());
  }
  cholmod_sparse sparse_view() {
    Sparse& m = expanded_.matrix();
    cholmod_sparse s{};
    s.nrow = s.ncol = std::size_t(size_);
    s.nzmax = std::size_t(m.nonZeros());
    s.p = m.outerIndexPtr();
    s.i = m.innerIndexPtr();
    s.x = m.valuePtr();
    s.stype = -1;
    s.itype = CHOLMOD_INT;
    s.xtype = CHOLMOD_REAL;
    s.dtype = CHOLMOD_DOUBLE;
    s.sorted = s.packed = 1;
    return s;
  }
  void release() {
    if (factor_) cholmod_free_factor(&factor_, &c_);
  }

  cholmod_common c_{};
  cholmod_factor* factor_ = nullptr;
  cholmod_dense *solution_ = nullptr, *work1_ = nullptr, *work2_ = nullptr;
  Expanded expanded_;
};

class EigenSolver final : public ReferenceSolver {
 public:
  void analyse(const BlockMatrix& a) override {
    size_ = 3 * a.nodes();
    factor_.analyzePattern(expanded_.pattern(a));
    entries_ = 0;
  }
  bool factorise(const BlockMatrix& a) override {
    factor_.factorize(expanded_.values(a));
    if (factor_.info() != Eigen::Success || !(factor_.vectorD().minCoeff() > 0)) return false;
    if (entries_ == 0) {
      const auto& l = factor_.matrixL().nestedExpression();
      flops_ = 0;
      for (int j = 0; j < size_; ++j) {
        const double n = double(l.outerIndexPtr()[j + 1] - l.outerIndexPtr()[j]) + 1;
        entries_ += std::int64_t(n);
        flops_ += n * n;
      }
    }
    return true;
  }

 private:
  void solve_columns(const MatX& b) override { x_ = factor_.solve(b); }
  Expanded expanded_;
  Eigen::SimplicialLDLT<Sparse> factor_;
};

}  // namespace

std::unique_ptr<ComplianceSolver> make_cholmod_solver() { return std::make_unique<CholmodSolver>(); }
std::unique_ptr<ComplianceSolver> make_eigen_solver() { return std::make_unique<EigenSolver>(); }

std::string blas_library() {
  Dl_info info{};
  void* dgemm = ::dlsym(RTLD_DEFAULT, "dgemm_");
  if (!dgemm || !::dladdr(dgemm, &info) || !info.dli_fname) return "unknown";
  std::error_code error;
  const auto file = std::filesystem::canonical(info.dli_fname, error);
  return error ? info.dli_fname : (file.parent_path().filename() / file.filename()).string();
}

}  // namespace insula
