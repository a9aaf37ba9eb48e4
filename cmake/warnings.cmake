# SPDX-License-Identifier: GPL-3.0-or-later
# Compiler flags that every target of the project shares. One processor flag for all: Eigen's alignment depends on it.
add_compile_options("$<$<CXX_COMPILER_ID:GNU,Clang>:-Wall;-Wextra;-Wshadow;-Wno-psabi;-Wno-missing-field-initializers>"
                    # GCC 12 reports these two inside its own string and variant templates.
                    "$<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized;-Wno-restrict>")
if(MSML_WERROR)
  # GCC 12 takes Eigen's AVX-512 headers for uses of uninitialised values.
  add_compile_options(-Werror -Wno-error=uninitialized)
endif()
if(MSML_NATIVE)
  add_compile_options(-march=native)
endif()
if(MSML_SANITIZE)
  # -O1: a third of the compile time, and call stacks that can be read.
  add_compile_options(-O1 -fsanitize=address,undefined -fno-omit-frame-pointer -fno-sanitize-recover=undefined)
  add_link_options(-fsanitize=address,undefined)
endif()
