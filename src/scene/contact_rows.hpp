// SPDX-License-Identifier: BSD-3-Clause
// Rows of a scene with coefficients for the contacts of some species only.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "scene/key.hpp"
#include "scene/scene_draft.hpp"

namespace carrom {

/// The fields restitution, tangential_restitution and friction, each of which a row may leave out.
std::vector<Field> contact_fields();

/// The number of rows of `discs.species`; nothing if the scene has no rows that can be read.
std::optional<std::size_t> count_species_rows(const SceneDraft& draft);
bool is_species_row(double number, std::size_t n_rows);

/// Why the three numbers of `row` from index `begin` on are wrong; empty if they are valid.
/// `why_smooth` names the condition without which the last two have no meaning; empty if it holds.
std::string problem_of_contact_numbers(const Numbers& row, std::size_t begin,
                                       std::string_view why_smooth);

} // namespace carrom
