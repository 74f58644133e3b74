// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

namespace springfit::io {

/// A JSON value whose objects keep the order in which they were written.
using Json = nlohmann::ordered_json;

} // namespace springfit::io
