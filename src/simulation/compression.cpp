// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/compression.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "core/errors.hpp"
#include "core/stop_request.hpp"
#include "initial_state/random_insertion.hpp"
#include "initial_state/velocities.hpp"
#include "simulation/advance.hpp"
#include "simulation/disc_system.hpp"

namespace carrom {

namespace {

constexpr double first_packing = 0.3; ///< packing of the random gas
/// Relative growth of radii in one stretch: that of the first stretch, the largest one, and the
/// largest one relative to the room. The room is the relative growth at which discs would jam.
constexpr double first_growth = 0.01, most_growth = 0.05, share_of_room = 0.1;
/// Discs count as jammed below this room; the pressure is about n kT / room, with the density n.
constexpr double jammed_room = 1e-6;
/// Radii grow by this share more than required, so that rounding leaves no overlap.
constexpr double margin = 0x1p-30;

class Compression {
public:
    Compression(const SceneParameters& scene, const Communicator& communicator,
                const Tuning& tuning)
        : scene_(scene), communicator_(communicator), tuning_(tuning),
          size_(std::min(1.0, std::sqrt(first_packing / scene.packing()))) {}

    /// Returns discs with valid positions; their velocities have no meaning.
    std::vector<InputDisc> run() {
        discs_ = insert_at_random(stretch(), communicator_, tuning_.threads);
        if (size_ == 1) return std::move(discs_);
        for (InputDisc& disc : discs_) {
            const Velocity velocity = drawn_velocity(scene_, disc.id);
            disc.vx = velocity.x;
            disc.vy = velocity.y;
        }
        for (bool is_last = false; !is_last;) {
            const double left = (1 + margin) / size_ - 1;
            is_last = growth_ >= left;
            growth_ = std::min(growth_, left);
            const double room = run_stretch();
            if (!is_last && room < jammed_room) fail_jammed("");
            size_ *= 1 + growth_;
            growth_ = std::min({most_growth, 2 * growth_, share_of_room * room});
        }
        return std::move(discs_);
    }

private:
    /// The scene of one stretch, which lasts one step of one micro-step. Masses are equal; walls
    /// and fixed bodies are elastic.
    SceneParameters stretch() const {
        SceneParameters scene;
        scene.name = scene_.name;
        scene.box = scene_.box;
        scene.n_discs = scene_.n_discs;
        scene.seed = scene_.seed;
        scene.radius = scene_.radius * size_;
        for (const Species& one : scene_.effects.species)
            scene.effects.species.push_back({one.count, one.radius * size_, 1});
        for (std::size_t side = 0; side < boundary_names.size(); ++side)
            if (scene_.effects.boundaries[side].is_periodic())
                scene.effects.boundaries[side].kind = BoundaryKind::periodic;
        scene.effects.fixed_bodies = scene_.effects.fixed_bodies;
        scene.effects.fixed_bodies.restitution = 1;
        scene.effects.fixed_bodies.surface = {};
        scene.effects.growth = growth_;
        scene.steps = scene.sync_every = 1;
        return scene;
    }

    /// Runs one stretch and returns the room. The root mean square speed of `discs_` is 1 before
    /// and after it. discs.growth_rate determines how far discs fly in a stretch. The room follows
    /// from the heating: if gaps shrink from a to b, speeds grow by a factor a/b.
    double run_stretch() {
        const double speed = 2 * scene_.radius * size_ * growth_ / scene_.compression_rate;
        for (InputDisc& disc : discs_) disc.vx *= speed, disc.vy *= speed;
        DiscSystem system(stretch(), std::move(discs_), communicator_, tuning_);
        try {
            advance_to(system, 1);
        } catch (const StopRequested&) {
            throw StopRequested(fmt::format(
                "stopped on request while discs are compressed, at a packing fraction of {:.4g} of "
                "{:.4g}; nothing is kept to go on from",
                scene_.packing() * size_ * size_, scene_.packing()));
        } catch (const CollectiveError& error) {
            fail_jammed(error.what());
        }
        const double now = std::sqrt(2 * system.totals().kinetic_energy /
                                     static_cast<double>(scene_.n_discs));
        discs_.clear();
        for (const DiscState& disc : system.shown())
            discs_.push_back({disc.id, disc.x_at(system.clock()), disc.y_at(system.clock()),
                              disc.vx / now, disc.vy / now});
        return now > speed ? growth_ / (now / speed - 1) : std::numeric_limits<double>::infinity();
    }

    [[noreturn]] void fail_jammed(const std::string& reason) const {
        throw InputError(
            {{scene_.name, 0,
              fmt::format("the compression jams at a packing fraction of {:.4g}, and {:.4g} is "
                          "wanted; take a smaller discs.growth_rate or another discs.seed{}{}",
                          scene_.packing() * size_ * size_, scene_.packing(),
                          reason.empty() ? "" : ": ", reason)}});
    }

    const SceneParameters& scene_;
    const Communicator& communicator_;
    const Tuning& tuning_;
    double size_;                  ///< present radii relative to the scene's radii
    double growth_ = first_growth; ///< share by which radii grow in the next stretch
    std::vector<InputDisc> discs_;
};

} // namespace

std::vector<InputDisc> compressed_places(const SceneParameters& scene,
                                         const Communicator& communicator, const Tuning& tuning) {
    return Compression(scene, communicator, tuning).run();
}

} // namespace carrom
