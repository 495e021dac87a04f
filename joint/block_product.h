// Products of 3×3 blocks, two entries at a time.
#pragma once

#include "pair.h"

namespace ductile::dynamics {

/// A 3×3 block, row by row.
struct Block {
  double a[9];
};

/// A block on the right of products: row by row, the first entry of each row once more at its end, so that
/// any two entries that follow each other in a product are made of two that follow each other here.
struct Right {
  double row[3][4];
};

inline Right right_of_transposed(const Block& b) {
  Right r;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 4; ++k) r.row[i][k] = b.a[3 * (k % 3) + i];
  }
  return r;
}

/// A block on the left of products: by columns, rows 0 and 1 together, row 2; each entry of a row twice.
struct Left {
  Pair row_0[3], upper[3], row_1[3], row_2[3];
  double bottom[3];
};

inline Left left_of(const Block& b) {
  Left l;
  for (int i = 0; i < 3; ++i) {
    const double r0 = b.a[i], r1 = b.a[3 + i], r2 = b.a[6 + i];
    l.row_0[i] = Pair{r0, r0};
    l.upper[i] = Pair{r0, r1};
    l.row_1[i] = Pair{r1, r1};
    l.row_2[i] = Pair{r2, r2};
    l.bottom[i] = r2;
  }
  return l;
}

/// block −= left · right
inline void subtract_product(Block& block, const Left& left, const Right& right) {
  const auto two = [&](const Pair(&rows)[3], int from) {
    return rows[0] * load(right.row[0] + from) + rows[1] * load(right.row[1] + from) +
           rows[2] * load(right.row[2] + from);
  };
  double* to = block.a;
  subtract(to, two(left.row_0, 0));
  subtract(to + 2, two(left.upper, 2));
  subtract(to + 4, two(left.row_1, 1));
  subtract(to + 6, two(left.row_2, 0));
  to[8] -=
      left.bottom[0] * right.row[0][2] + left.bottom[1] * right.row[1][2] + left.bottom[2] * right.row[2][2];
}

}  // namespace ductile::dynamics
