// Every operator new of the test program is counted.
#pragma once

namespace ductile {
long allocations();
}
