# clang with libc++, as on macOS. toml++ is used as headers, of which PKG_CONFIG_LIBDIR tells.
set(CMAKE_C_COMPILER clang)
set(CMAKE_CXX_COMPILER clang++)
set(CMAKE_CXX_FLAGS_INIT -stdlib=libc++)
