// The Householder reflections that SPQR takes from LAPACK, with LAPACK's names, arguments and conventions
// (LAPACK Users' Guide, 3rd ed., section 5.4; Schreiber & Van Loan, SIAM J. Sci. Stat. Comput. 10 (1989) for
// the block form): Debian has LAPACK in Fortran alone, which does not compile to WebAssembly.
#include <Eigen/Core>
#include <cmath>
#include <cstdlib>

namespace {
using Eigen::Index;
using Matrix = Eigen::Map<Eigen::MatrixXd, 0, Eigen::OuterStride<>>;
using ConstMatrix = Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;
using Vector = Eigen::Map<Eigen::VectorXd, 0, Eigen::InnerStride<>>;
using ConstVector = Eigen::Map<const Eigen::VectorXd, 0, Eigen::InnerStride<>>;

void require(bool is_what_spqr_asks_for) {
  if (!is_what_spqr_asks_for) std::abort();
}
}  // namespace

extern "C" {

double dnrm2_(const int* n, const double* x, const int* step) {
  return ConstVector(x, *n, Eigen::InnerStride<>(*step)).stableNorm();
}

// H = I − τ (1; v)(1; v)ᵀ with H (α; x) = (β; 0): β into α, v into x.
void dlarfg_(const int* n, double* alpha, double* x, const int* step, double* tau) {
  *tau = 0;
  if (*n <= 1) return;
  Vector v(x, *n - 1, Eigen::InnerStride<>(*step));
  const double norm = v.stableNorm();
  if (norm == 0) return;
  const double beta = -std::copysign(std::hypot(*alpha, norm), *alpha);
  *tau = (beta - *alpha) / beta;
  v /= *alpha - beta;
  *alpha = beta;
}

// C := H C or C H.
void dlarf_(const char* side, const int* m, const int* n, const double* v, const int* step, const double* tau,
            double* c, const int* ldc, double* /*work*/) {
  Matrix C(c, *m, *n, Eigen::OuterStride<>(*ldc));
  if (*side == 'L') {
    const ConstVector w(v, *m, Eigen::InnerStride<>(*step));
    const Eigen::RowVectorXd along = w.transpose() * C;
    C.noalias() -= *tau * w * along;
  } else {
    const ConstVector w(v, *n, Eigen::InnerStride<>(*step));
    const Eigen::VectorXd along = C * w;
    C.noalias() -= *tau * along * w.transpose();
  }
}

// T, upper triangular, with H₁ H₂ … H_k = I − V T Vᵀ.
void dlarft_(const char* direct, const char* storev, const int* n, const int* k, const double* v,
             const int* ldv, const double* tau, double* t, const int* ldt) {
  require(*direct == 'F' && *storev == 'C');
  const ConstMatrix stored(v, *n, *k, Eigen::OuterStride<>(*ldv));
  const Eigen::MatrixXd V = stored.triangularView<Eigen::UnitLower>();
  Matrix T(t, *k, *k, Eigen::OuterStride<>(*ldt));
  for (Index i = 0; i < *k; ++i) {
    const Eigen::VectorXd along = -tau[i] * (V.leftCols(i).transpose() * V.col(i));
    T.col(i).head(i) = T.topLeftCorner(i, i).triangularView<Eigen::Upper>() * along;
    T(i, i) = tau[i];
  }
}

// C := H C, Hᵀ C, C H or C Hᵀ for H = I − V T Vᵀ.
void dlarfb_(const char* side, const char* trans, const char* direct, const char* storev, const int* m,
             const int* n, const int* k, const double* v, const int* ldv, const double* t, const int* ldt,
             double* c, const int* ldc, double* /*work*/, const int* /*ldwork*/) {
  require(*direct == 'F' && *storev == 'C');
  const bool left = *side == 'L';
  const ConstMatrix stored(v, left ? *m : *n, *k, Eigen::OuterStride<>(*ldv));
  const Eigen::MatrixXd V = stored.triangularView<Eigen::UnitLower>();
  const ConstMatrix square(t, *k, *k, Eigen::OuterStride<>(*ldt));
  Eigen::MatrixXd T = square.triangularView<Eigen::Upper>();
  if (*trans != 'N') T.transposeInPlace();
  Matrix C(c, *m, *n, Eigen::OuterStride<>(*ldc));
  if (left) {
    const Eigen::MatrixXd along = T * (V.transpose() * C);
    C.noalias() -= V * along;
  } else {
    const Eigen::MatrixXd along = (C * V) * T;
    C.noalias() -= along * V.transpose();
  }
}

}  // extern "C"
