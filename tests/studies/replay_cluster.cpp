// SPDX-License-Identifier: BSD-3-Clause
// Replays the windows of a run on a large simulated cluster: SimGrid models the network, and each
// rank is an actor that computes for given times and sends messages of given sizes. Nothing is
// stepped, so ten thousand ranks fit one process (cluster_model.py writes the script).
//
//   replay_cluster PLATFORM <SCRIPT
//
// A script is a list of numbers and words:
//
//   RANKS RANKS_PER_NODE WINDOWS
//   for each rank: the number of partners, and for each of them RANK DISCS_SENT DISCS_RECEIVED
//   the number of phases of a window, and for each of them one of
//     exchange BYTES  a message to each partner, of BYTES for each disc, and one from each
//     reduce BYTES    a reduction over all ranks (recursive doubling, as MPI libraries do)
//     compute         the time of the rank for this window
//     again           phases from here on belong to a rollback
//   for each window: a nanosecond time for each rank, and the number of ranks that a rollback makes
//   compute again, with RANK NANOSECONDS for each; -1 if the window has no rollback
//
// One line on standard output: the mean nanoseconds of a window, the means over ranks and windows
// of nanoseconds spent computing, exchanging and reducing, and messages and bytes of a rank and
// window that are sent in exchanges.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include <simgrid/s4u.hpp>

namespace sg = simgrid::s4u;

namespace {

/// An exchange sends this much at once, and the rest in a second message
/// (src/parallel/neighbour_exchange.cpp).
constexpr double first_bytes = 3968, header_bytes = 16;

struct Partner {
    int rank = 0;
    double sent = 0, received = 0; ///< numbers of discs
};

enum class Kind { exchange, reduce, compute, again };

struct Phase {
    Kind kind = Kind::compute;
    double bytes = 0;
};

struct WindowTimes {
    std::vector<double> first; ///< nanoseconds, by rank
    bool is_repeated = false;
    std::map<int, double> again{}; ///< nanoseconds of ranks that compute again
};

struct Script {
    int n_ranks = 1, ranks_per_node = 1;
    std::vector<std::vector<Partner>> partners{};
    std::vector<Phase> phases{};
    std::vector<WindowTimes> windows{};
};

struct Tally {
    double computing = 0, exchanging = 0, reducing = 0; ///< seconds in each phase
    double messages = 0, bytes = 0;
};

Phase read_phase() {
    std::string word;
    Phase phase;
    std::cin >> word;
    if (word == "compute") return phase;
    if (word == "again") return {Kind::again};
    phase.kind = word == "exchange" ? Kind::exchange : Kind::reduce;
    std::cin >> phase.bytes;
    return phase;
}

Script read_script() {
    Script script;
    int n_windows = 0, n_phases = 0;
    std::cin >> script.n_ranks >> script.ranks_per_node >> n_windows;
    for (int rank = 0; rank < script.n_ranks; ++rank) {
        std::size_t n = 0;
        std::cin >> n;
        std::vector<Partner>& partners = script.partners.emplace_back(n);
        for (Partner& partner : partners)
            std::cin >> partner.rank >> partner.sent >> partner.received;
    }
    std::cin >> n_phases;
    for (int k = 0; k < n_phases; ++k) script.phases.push_back(read_phase());
    for (int k = 0; k < n_windows; ++k) {
        WindowTimes& window = script.windows.emplace_back();
        window.first.resize(script.partners.size());
        for (double& time : window.first) std::cin >> time;
        int n_again = -1;
        std::cin >> n_again;
        window.is_repeated = n_again >= 0;
        for (int i = 0; i < n_again; ++i) {
            int rank = 0;
            double time = 0;
            std::cin >> rank >> time;
            window.again[rank] = time;
        }
    }
    return script;
}

/// The mailbox for messages between these two ranks.
sg::Mailbox* mailbox(const char* kind, int from, int to) {
    return sg::Mailbox::by_name(kind + std::to_string(from) + '-' + std::to_string(to));
}

/// One rank. Small messages are sent at once; a large one waits until the receiver is ready.
class Rank {
public:
    Rank(const Script& script, int rank, Tally& tally)
        : script_(script), rank_(rank), tally_(tally) {
        for (const Partner& partner : script.partners[place()]) {
            links_.push_back({mailbox("s", rank, partner.rank), mailbox("s", partner.rank, rank),
                              mailbox("l", rank, partner.rank), mailbox("l", partner.rank, rank)});
            links_.back().small_in->set_receiver(sg::Actor::self());
        }
        for (half_ = 1; 2 * half_ <= script.n_ranks; half_ *= 2) {
        }
        if (rank_ >= half_) {
            add_ring(rank_ - half_);
            return;
        }
        if (rank_ + half_ < script.n_ranks) add_ring(rank_ + half_);
        for (int bit = 1; bit < half_; bit *= 2) add_ring(rank_ ^ bit);
    }

    void live() {
        for (const WindowTimes& window : script_.windows) run(window);
    }

private:
    struct Link {
        sg::Mailbox *small_out, *small_in, *large_out, *large_in;
    };
    struct Ring {
        sg::Mailbox *out, *in;
    };

    std::size_t place() const { return static_cast<std::size_t>(rank_); }

    void add_ring(int other) {
        rings_.push_back({mailbox("r", rank_, other), mailbox("r", other, rank_)});
        rings_.back().in->set_receiver(sg::Actor::self());
    }

    void run(const WindowTimes& window) {
        bool is_again = false;
        for (const Phase& phase : script_.phases) {
            const double start = sg::Engine::get_clock();
            switch (phase.kind) {
            case Kind::again:
                if (!window.is_repeated) return;
                is_again = true;
                break;
            case Kind::compute:
                compute(window, is_again);
                tally_.computing += sg::Engine::get_clock() - start;
                break;
            case Kind::exchange:
                exchange(phase.bytes);
                tally_.exchanging += sg::Engine::get_clock() - start;
                break;
            case Kind::reduce:
                reduce(phase.bytes);
                tally_.reducing += sg::Engine::get_clock() - start;
                break;
            }
        }
    }

    void compute(const WindowTimes& window, bool is_again) {
        double time = window.first[place()];
        if (is_again) {
            const auto found = window.again.find(rank_);
            time = found == window.again.end() ? 0 : found->second;
        }
        if (time > 0) sg::this_actor::sleep_for(time * 1e-9);
    }

    void exchange(double bytes_per_disc) {
        std::vector<sg::CommPtr> comms;
        for (std::size_t k = 0; k < links_.size(); ++k) {
            const Partner& partner = script_.partners[place()][k];
            const double out = partner.sent * bytes_per_disc + header_bytes,
                         in = partner.received * bytes_per_disc + header_bytes;
            comms.push_back(links_[k].small_in->get_async<char>(&received_));
            send(links_[k].small_out, std::min(out, first_bytes), comms);
            if (out > first_bytes) send(links_[k].large_out, out - first_bytes, comms);
            if (in > first_bytes) comms.push_back(links_[k].large_in->get_async<char>(&received_));
        }
        for (const sg::CommPtr& comm : comms) comm->wait();
    }

    void send(sg::Mailbox* to, double bytes, std::vector<sg::CommPtr>& comms) {
        comms.push_back(to->put_async(&sent_, static_cast<std::uint64_t>(bytes)));
        tally_.messages += 1;
        tally_.bytes += bytes;
    }

    /// Ranks beyond the largest power of two send to one of the others, which returns the result at
    /// the end.
    void reduce(double bytes) {
        if (rings_.empty()) return;
        const auto size = static_cast<std::uint64_t>(bytes);
        if (rank_ >= half_) {
            rings_[0].out->put(&sent_, size);
            rings_[0].in->get<char>();
            return;
        }
        const bool has_guest = rank_ + half_ < script_.n_ranks;
        if (has_guest) rings_[0].in->get<char>();
        for (std::size_t k = has_guest; k < rings_.size(); ++k) {
            const sg::CommPtr out = rings_[k].out->put_async(&sent_, size);
            rings_[k].in->get<char>();
            out->wait();
        }
        if (has_guest) rings_[0].out->put(&sent_, size);
    }

    const Script& script_;
    int rank_;
    Tally& tally_;
    int half_ = 1; ///< the largest power of two that is not above the number of ranks
    std::vector<Link> links_;
    std::vector<Ring> rings_; ///< partners of a reduction, in their order
    char sent_ = 0;
    char* received_ = nullptr;
};

void print_row(const Script& script, const std::vector<Tally>& tallies) {
    Tally all;
    for (const Tally& tally : tallies) {
        all.computing += tally.computing;
        all.exchanging += tally.exchanging;
        all.reducing += tally.reducing;
        all.messages += tally.messages;
        all.bytes += tally.bytes;
    }
    const auto n_windows = static_cast<double>(script.windows.size());
    const double n = n_windows * script.n_ranks;
    std::printf("%.6g,%.6g,%.6g,%.6g,%.5g,%.6g\n", sg::Engine::get_clock() * 1e9 / n_windows,
                all.computing * 1e9 / n, all.exchanging * 1e9 / n, all.reducing * 1e9 / n,
                all.messages / n, all.bytes / n);
}

} // namespace

int main(int argc, char** argv) {
    sg::Engine engine(&argc, argv); // removes its own options
    if (argc != 2) {
        std::fprintf(stderr, "replay_cluster PLATFORM <SCRIPT\n");
        return 2;
    }
    // latency + bytes / bandwidth, shared by all messages on a link
    sg::Engine::set_config("network/model:CM02");
    sg::Engine::set_config("network/TCP-gamma:0");
    sg::Engine::set_config("contexts/stack-size:64");
    sg::Engine::set_config("contexts/guard-size:0");
    engine.load_platform(argv[1]);
    const Script script = read_script();
    std::vector<Tally> tallies(script.partners.size());
    for (int rank = 0; rank < script.n_ranks; ++rank) {
        const int node = rank / script.ranks_per_node;
        sg::Actor::create("rank-" + std::to_string(rank),
                          engine.host_by_name("node-" + std::to_string(node)),
                          [&script, &tallies, rank] {
                              Rank(script, rank, tallies[static_cast<std::size_t>(rank)]).live();
                          });
    }
    engine.run();
    print_row(script, tallies);
    return 0;
}
