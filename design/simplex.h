// How linear programmes are solved: GLPK's simplex method to 1e-9, in units near 1 (units.h).
#pragma once

#include <glpk.h>

namespace ductile {

inline glp_smcp simplex_settings() {
  glp_smcp settings;
  glp_init_smcp(&settings);
  settings.tol_bnd = settings.tol_dj = 1e-9;
  settings.tm_lim = 600'000;  // ms
  return settings;
}

}  // namespace ductile
