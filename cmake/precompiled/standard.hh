// SPDX-License-Identifier: GPL-2.0-or-later
// Headers of the standard library that most sources include, parsed once (cmake/Precompiled.cmake). Sources
// still include all headers that they use, because the preset dev has no precompiled headers.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <deque>
#include <expected>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>
