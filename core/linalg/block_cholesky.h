// SPDX-License-Identifier: GPL-3.0-or-later
// Direct solver of one body's system matrix: multifrontal supernodal Cholesky A = P^T L L^T P on 3x3 blocks, and the
// compliance H A^-1 H^T of sparse rows by forward substitution on the rows that the elimination tree reaches.
// Ordering and supernodes come from CHOLMOD once per topology; everything after analyse() allocates nothing unless the
// number of rows grows past what was seen.
#pragma once
#include <cstdint>
#include <vector>

#include "core/linalg/body_solver.h"

namespace insula {

class BlockCholesky final : public BodySolver {
 public:
  std::string name() const override { return "direct"; }
  void analyse(const BlockMatrix& a) override;
  bool factorise(const BlockMatrix& a) override;
  void solve(double* x) override;
  void begin_compliance(const BodyRows& rows, const std::vector<int>& node_of_block) override;
  int compliance_parts() const override { return columns_ >= 2 * least_part ? most_parts : columns_ > 0 && nodes_ > 0 ? 1 : 0; }
  void compliance_part(int part) override;
  void end_compliance() override;
  void add_compliance(const BodyRows& rows, double* w, int stride) const override;
  void correct(const BodyRows& rows, const double* lambda, double* x) override;
  SolverCost cost() const override { return {entries_, flops_, 16.0 * double(entries_)}; }
  int supernodes() const { return int(front_.size()); }

 private:
  static constexpr int most_parts = 4, least_part = 32;  ///< parts; columns that are worth one

  struct Front {
    int first = 0;        ///< first own node, permuted order
    int own = 0;          ///< own nodes (columns)
    int rows = 0;         ///< nodes in all (own + below)
    int row_begin = 0;    ///< into row_node_
    int lda = 0;          ///< of the panel, scalars
    long panel = 0;       ///< offset into panel_
    long update = -1;     ///< offset into update_, of the below x below matrix
    int ldu = 0;
    int parent = -1;
    int map_begin = 0;    ///< into map_: below nodes as positions in the parent's rows
    int scatter_begin = 0, scatter_end = 0;
    int first_descendant = 0;  ///< first own node of the subtree
    std::vector<int> children;
  };
  struct Scatter {
    int slot;
    long offset;   ///< of the block's first entry in the panel
    bool transpose;
  };
  void forward(double* x);
  void backward(double* x);

  int nodes_ = 0;
  std::vector<Front> front_;
  std::vector<int> row_node_, map_, row_scalar_;
  std::vector<int> permuted_;   ///< natural node -> permuted node
  std::vector<int> natural_;
  std::vector<int> front_of_;   ///< permuted node -> front
  std::vector<Scatter> scatter_;
  std::vector<double> panel_, update_, x_, below_;  ///< below_: of one front, gathered
  std::int64_t entries_ = 0;
  double flops_ = 0;

  // Rows in flight.
  std::vector<double> y_, s_, lambda_;
  std::vector<int> order_, begin_, active_lo_, active_hi_;
  long ldy_ = 0;
  int columns_ = 0;
};

}  // namespace insula
