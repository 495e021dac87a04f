#include <stdexcept>

#include "ductile/view.h"

namespace ductile {

ViewCost view(const ViewDef&) {
  throw std::runtime_error(
      "this ductile was built without its window; ./dev view builds it with (CMake: -DDUCTILE_VIEWER=ON, "
      "Debian packages libglfw3-dev libimgui-dev libgl-dev libpng-dev)");
}

}  // namespace ductile
