// SPDX-License-Identifier: GPL-3.0-or-later
// Long arrays whose memory is first touched by the loops that fill them.
#pragma once
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <memory>
#include <vector>

namespace msml::fe {

/// Leaves new numbers as they are where std::allocator sets them to zero.
template <class T>
struct Untouched : std::allocator<T> {
  template <class Other>
  struct rebind {
    using other = Untouched<Other>;
  };
  template <class Number>
  void construct(Number* place) {
    ::new (static_cast<void*>(place)) Number;
  }
  template <class Number, class... Values>
  void construct(Number* place, Values&&... values) {
    ::new (static_cast<void*>(place)) Number(std::forward<Values>(values)...);
  }
};

/// The system gives a page of memory to the thread that first touches it, which takes longer than to fill it: several
/// threads ask side by side if resize() leaves that to a parallel loop, such as that of set_zero.
template <class T>
using Numbers = std::vector<T, Untouched<T>>;

/// Becomes `size` zeros.
template <class T>
void set_zero(Numbers<T>& numbers, std::size_t size) {
  if (numbers.capacity() < size) Numbers<T>().swap(numbers);  // nothing to be moved
  numbers.resize(size);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, size, 1 << 16),
                    [&](const auto& range) { std::fill(&numbers[range.begin()], &numbers[0] + range.end(), T(0)); });
}

}  // namespace msml::fe
