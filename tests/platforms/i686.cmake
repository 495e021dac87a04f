set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR i686)
set(CMAKE_C_COMPILER i686-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER i686-linux-gnu-g++)
set(CMAKE_EXE_LINKER_FLAGS_INIT -static)  # needs no libraries of that platform where it runs
# Sums in registers of 80 bits are other sums; section/ relies on double's rounding.
set(CMAKE_CXX_FLAGS_INIT "-msse2 -mfpmath=sse")
