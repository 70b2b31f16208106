// SPDX-License-Identifier: BSD-3-Clause
#include "measure/older_sums.hpp"

#include <map>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "core/errors.hpp"
#include "measure/kept_numbers.hpp"

namespace carrom {

namespace {

using Words = std::vector<std::int64_t>;

struct OldField {
    std::string_view name;
    std::int64_t only_with = 0; ///< a bit of "quantities"; the field exists only with it
    bool is_list = true;        ///< its size comes first
};

/// In the order of the older words, after the number of their format.
constexpr OldField older_fields[] = {{"quantities", 0, false},
                                     {"every_steps", 0, false},
                                     {"from_step", 0, false},
                                     {"distance", 0, false},
                                     {"velocity", 0, false},
                                     {"first_step", 0, false},
                                     {"last_step", 0, false},
                                     {"speed_scale", 0, false},
                                     {"n_samples", 0, false},
                                     {"n_discs", 0, false},
                                     {"area", 0, false},
                                     {"pairs"},
                                     {"vx"},
                                     {"vy"},
                                     {"speeds"},
                                     {"x"},
                                     {"y"},
                                     {"pending"},
                                     {"left", 0, false},
                                     {"right", 0, false},
                                     {"bottom", 0, false},
                                     {"top", 0, false},
                                     {"ideal_pairs"},
                                     {"impulses"},
                                     {"displacements"},
                                     {"pressures"},
                                     {"last_motion"},
                                     {"virial_bound", 0, false},
                                     {"pending_virial"},
                                     {"thermo", 64},
                                     {"psi6", 128},
                                     {"neighbours", 128},
                                     {"moduli", 128},
                                     {"psi6_pairs", 128},
                                     {"psi6_products", 128},
                                     {"wavenumber", 256, false},
                                     {"structure_factor", 256},
                                     {"correlation", 512, false},
                                     {"flights", 512}};

/// A quantity and its fields in the order of Measurement::keep; '#' is the size of a list alone.
struct OlderQuantity {
    std::string_view name;
    std::int64_t bit;
    std::vector<std::string_view> fields;
};

const std::vector<OlderQuantity>& older_quantities() {
    static const std::vector<OlderQuantity> all = {
        {"wall_pressure",
         1,
         {"speed_scale", "left", "right", "bottom", "top", "impulses", "pending"}},
        {"radial_distribution", 2, {"distance", "#pairs", "pairs", "ideal_pairs"}},
        {"velocities", 4, {"velocity", "#vx", "vx", "vy", "speeds"}},
        {"density", 8, {"#x", "x", "y"}},
        {"displacement", 16, {"displacements"}},
        {"psi6",
         128,
         {"distance", "#moduli", "psi6", "neighbours", "moduli", "psi6_pairs", "psi6_products"}},
        {"structure_factor", 256, {"wavenumber", "#structure_factor", "structure_factor"}},
        {"diffusion", 512, {"correlation", "flights"}}};
    return all;
}

/// The words of each field, with the size of a list first; nothing if words are missing.
std::map<std::string_view, Words> older_values(const Words& words) {
    std::map<std::string_view, Words> values;
    std::size_t next = 1;
    for (const OldField& field : older_fields) {
        if (field.only_with != 0 && (values["quantities"][0] & field.only_with) == 0) continue;
        if (next >= words.size()) return {};
        const std::uint64_t size = field.is_list ? static_cast<std::uint64_t>(words[next]) : 0;
        if (size > words.size() - next - 1) return {};
        const auto begin = words.begin() + static_cast<std::ptrdiff_t>(next);
        values[field.name] = Words(begin, begin + static_cast<std::ptrdiff_t>(size) + 1);
        next += size + 1;
    }
    return next == words.size() ? values : std::map<std::string_view, Words>{};
}

/// Stress is integrated over time now; sums of version 0.2 lack what that takes.
void refuse_stress(std::int64_t quantities, std::int64_t step) {
    constexpr std::int64_t pressure = 32, thermo = 64;
    if ((quantities & (pressure | thermo)) == 0) return;
    throw InputError(
        {{"[output.measurements]", 0,
          fmt::format("the checkpoint is of carrom 0.2, and its sums of \"{}\" are of another "
                      "kind: begin anew with output.measurements.from_step = {}",
                      (quantities & pressure) != 0 ? "pressure" : "thermo", step)}});
}

} // namespace

Words in_present_form(const Words& words, std::int64_t step) {
    constexpr std::int64_t older = 2, present = 3;
    if (words.empty() || words[0] != older) return words;
    const std::map<std::string_view, Words> values = older_values(words);
    if (values.empty()) return words;
    const std::int64_t measured = values.at("quantities")[0];
    refuse_stress(measured, step);
    std::vector<std::string> names;
    for (const OlderQuantity& quantity : older_quantities())
        if (measured & quantity.bit) names.emplace_back(quantity.name);
    KeptNumbers kept;
    std::int64_t form = present;
    kept(form), kept(names);
    const auto add = [&values](auto&& name, Words& to) {
        const bool is_size = name.front() == '#';
        const Words& of = values.at(is_size ? name.substr(1) : name);
        to.insert(to.end(), of.begin(), is_size ? of.begin() + 1 : of.end());
    };
    Words result = kept.take_words();
    for (const std::string_view name :
         {"every_steps", "from_step", "first_step", "last_step", "n_samples", "n_discs", "area"})
        add(name, result);
    for (const OlderQuantity& quantity : older_quantities()) {
        if ((measured & quantity.bit) == 0) continue;
        Words own;
        for (const std::string_view name : quantity.fields) add(name, own);
        result.push_back(static_cast<std::int64_t>(own.size()));
        result.insert(result.end(), own.begin(), own.end());
    }
    return result;
}

} // namespace carrom
