// SPDX-License-Identifier: GPL-3.0-or-later
// CHOLMOD and Eigen as solvers of one body.
#include "tools/workbench/reference_solvers.h"

#include <Eigen/SparseCholesky>
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

/// Everything but the factor.
class ReferenceSolver : public ComplianceSolver {
 public:
  void solve(double* x) override {
    one_ = Eigen::Map<VecX>(x, size_);
    Eigen::Map<VecX>(x, size_) = solved(one_);
  }
  void begin_compliance(const BodyRows& rows, const std::vector<int>& node_of_block) override {
    const int m = rows.count();
    entries_of_h_.clear();
    for (int r = 0; r < m; ++r)
      for (int e = rows.start[std::size_t(r)]; e < rows.start[std::size_t(r) + 1]; ++e)
        if (const int node = node_of_block[std::size_t(rows.block[std::size_t(e)])]; node >= 0)
          for (int k = 0; k < 3; ++k) entries_of_h_.emplace_back(3 * node + k, r, rows.coeff[std::size_t(e)][k]);
    h_.resize(size_, m);
    h_.setFromTriplets(entries_of_h_.begin(), entries_of_h_.end());
    columns_ = m;
    w_.setZero(m, m);
  }
  int compliance_parts(ComplianceAct act) const override {
    return act == ComplianceAct::product && columns_ > 0 && size_ > 0 ? 1 : 0;
  }
  void compliance_part(ComplianceAct, int) override {
    right_ = h_;
    compliance(h_, right_, w_);
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
  using Columns = Eigen::Map<const MatX>;
  /// A^-1 b. The result lives until the next call.
  virtual Columns solved(const MatX& b) = 0;
  /// W of the columns of H^T, which are there sparse and dense.
  virtual void compliance(const Sparse& h, const MatX& dense, MatX& w) { w = h.transpose() * solved(dense); }
  int size_ = 0;
  std::int64_t entries_ = 0;
  double flops_ = 0;

 private:
  std::vector<Eigen::Triplet<double>> entries_of_h_;
  Sparse h_;
  MatX one_, right_, w_;
  int columns_ = 0;
};

class CholmodSolver final : public ReferenceSolver {
 public:
  CholmodSolver(std::shared_ptr<const CholmodLibrary> library, ReferenceW w) : library_(std::move(library)), kind_(w) {
    library_->start(&c_);
    c_.print = 0;
    c_.supernodal = CHOLMOD_SUPERNODAL;
  }
  ~CholmodSolver() override {
    release();
    for (cholmod_dense** d : {&solution_, &permuted_, &work1_, &work2_}) library_->free_dense(d, &c_);
    library_->finish(&c_);
  }
  CholmodSolver(const CholmodSolver&) = delete;
  CholmodSolver& operator=(const CholmodSolver&) = delete;

  void analyse(const BlockMatrix& a) override {
    release();
    size_ = 3 * a.nodes();
    expanded_.pattern(a);
    cholmod_sparse view = sparse_view();
    factor_ = library_->analyze(&view, &c_);
    if (!factor_) throw std::runtime_error("CHOLMOD's symbolic factorisation failed");
    flops_ = c_.fl;
    entries_ = std::int64_t(c_.lnz);
  }
  bool factorise(const BlockMatrix& a) override {
    library_->one_thread();
    expanded_.values(a);
    cholmod_sparse view = sparse_view();
    return library_->factorize(&view, factor_, &c_) && c_.status == CHOLMOD_OK;
  }

 private:
  Columns solved(const MatX& b) override {
    library_->one_thread();
    cholmod_dense right = dense_view(b);
    system(CHOLMOD_A, right, solution_);
    return columns_of(solution_);
  }
  void compliance(const Sparse& h, const MatX& dense, MatX& w) override {
    if (kind_ == ReferenceW::full) return ReferenceSolver::compliance(h, dense, w);
    library_->one_thread();
    cholmod_dense right = dense_view(dense);
    system(CHOLMOD_P, right, permuted_);
    system(CHOLMOD_L, *permuted_, solution_);
    const int m = int(w.rows()), n = int(solution_->nrow), ld = int(solution_->d);
    const double one = 1, zero = 0;
    library_->dsyrk("L", "T", &m, &n, &one, static_cast<const double*>(solution_->x), &ld, &zero, w.data(), &m);
    w.triangularView<Eigen::StrictlyUpper>() = w.transpose();
  }
  void system(int which, cholmod_dense& right, cholmod_dense*& into) {
    if (!library_->solve2(which, factor_, &right, nullptr, &into, nullptr, &work1_, &work2_, &c_))
      throw std::runtime_error("CHOLMOD's solve failed");
  }
  static Columns columns_of(const cholmod_dense* d) {
    return {static_cast<const double*>(d->x), Eigen::Index(d->nrow), Eigen::Index(d->ncol)};
  }
  static cholmod_dense dense_view(const MatX& b) {
    cholmod_dense right{};
    right.nrow = right.d = std::size_t(b.rows());
    right.ncol = std::size_t(b.cols());
    right.nzmax = right.nrow * right.ncol;
    right.x = const_cast<double*>(b.data());
    right.xtype = CHOLMOD_REAL;
    right.dtype = CHOLMOD_DOUBLE;
    return right;
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
    if (factor_) library_->free_factor(&factor_, &c_);
  }

  std::shared_ptr<const CholmodLibrary> library_;
  ReferenceW kind_;
  cholmod_common c_{};
  cholmod_factor* factor_ = nullptr;
  cholmod_dense *solution_ = nullptr, *permuted_ = nullptr, *work1_ = nullptr, *work2_ = nullptr;
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
  Columns solved(const MatX& b) override {
    x_ = factor_.solve(b);
    return {x_.data(), x_.rows(), x_.cols()};
  }
  Expanded expanded_;
  Eigen::SimplicialLDLT<Sparse> factor_;
  MatX x_;
};

}  // namespace

std::unique_ptr<ComplianceSolver> make_cholmod_solver(std::shared_ptr<const CholmodLibrary> library, ReferenceW w) {
  return std::make_unique<CholmodSolver>(std::move(library), w);
}
std::unique_ptr<ComplianceSolver> make_eigen_solver() { return std::make_unique<EigenSolver>(); }

}  // namespace insula
