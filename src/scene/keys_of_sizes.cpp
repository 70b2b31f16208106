// SPDX-License-Identifier: BSD-3-Clause
// The keys of [discs.radius]: radii that follow a distribution.
#include "scene/key_members.hpp"
#include "scene/limits.hpp"

namespace carrom {

template <>
inline constexpr std::array words_of<SizeKind>{Word<SizeKind>{"uniform", SizeKind::uniform},
                                               Word<SizeKind>{"normal", SizeKind::normal},
                                               Word<SizeKind>{"lognormal", SizeKind::lognormal}};
template <>
inline constexpr std::array words_of<MassKind>{Word<MassKind>{"area", MassKind::area},
                                               Word<MassKind>{"equal", MassKind::equal}};

namespace {

/// The range of the smallest and the largest radius, in units of the mean.
constexpr Range shares{0x1p-20, 0x1p20};

/// The scene's distribution. Scenes without the table have the defaults.
const SizeDistribution& sizes_of(const SceneParameters& scene) {
    static const SizeDistribution defaults;
    if (scene.sizes) return *scene.sizes;
    return defaults;
}
SizeDistribution& sizes_of(SceneParameters& scene) {
    return scene.sizes ? *scene.sizes : scene.sizes.emplace();
}

template <class Member>
Key size_key(std::string_view name, std::string_view unit, std::string_view help,
             Member SizeDistribution::* member) {
    return key("discs.radius." + std::string(name), unit, help,
               [member](auto& scene) -> auto& { return sizes_of(scene).*member; })
        .needs({"without a distribution of radii",
                [](const SceneParameters& s) { return s.sizes.has_value(); }});
}

} // namespace

std::vector<Key> keys_of_sizes() {
    using Sizes = SizeDistribution;
    return {
        size_key("distribution", "", "The distribution of the radii.", &Sizes::kind)
            .advises({{"gaussian", "\"normal\""},
                      {"log-normal", "\"lognormal\""},
                      {"flat", "\"uniform\""},
                      {"bimodal", "discs.species, in place of discs.count and discs.radius"},
                      {"bidisperse", "discs.species, in place of discs.count and discs.radius"}}),
        size_key("mean", "length", "The mean radius; or give 'discs.packing'.", &Sizes::mean)
            .by_default("from 'discs.packing'")
            .within({smallest_length, largest_size})
            .excludes({"discs.packing"}),
        size_key("polydispersity", "1", "Standard deviation of the radii over their mean.",
                 &Sizes::polydispersity)
            .within({0, 1}),
        size_key("smallest", "1", "No radius is smaller, in units of the mean.", &Sizes::smallest)
            .by_default("where the distribution ends: three standard deviations from its middle")
            .within(shares),
        size_key("largest", "1", "No radius is larger, in units of the mean.", &Sizes::largest)
            .by_default("where the distribution ends")
            .within(shares),
        size_key("mass", "",
                 "Area: as the area, 1 for a disc of the mean radius. Equal: 1 for all.",
                 &Sizes::mass),
    };
}

} // namespace carrom
