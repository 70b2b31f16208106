// SPDX-License-Identifier: BSD-3-Clause
// Rows of scenes that give other numbers to contacts of some species.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "scene/key.hpp"
#include "scene/scene_draft.hpp"

namespace carrom {

/// The fields restitution, tangential_restitution and friction, each of which a row may leave out.
std::vector<Field> contact_fields();

/// The number of rows of `discs.species`; nothing if the scene has none that can be read.
std::optional<std::size_t> count_species_rows(const SceneDraft& draft);
bool is_species_row(double number, std::size_t n_rows);

/// Why the three numbers of `row` from index `first` on are wrong, or empty. `why_smooth` says
/// without what the last two have no meaning; it is empty if they have one.
std::string problem_of_contact_numbers(const Numbers& row, std::size_t first,
                                       std::string_view why_smooth);

} // namespace carrom
