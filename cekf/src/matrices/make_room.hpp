// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace helixnav::cekf {

/// Room for `more` elements, so that appending them cannot throw; grows in proportion, as push_back would.
template <class Element>
void make_room(std::vector<Element>& elements, std::size_t more) {
  const std::size_t wanted = elements.size() + more;
  if (wanted > elements.capacity()) elements.reserve(wanted + wanted / 2);
}

}  // namespace helixnav::cekf
