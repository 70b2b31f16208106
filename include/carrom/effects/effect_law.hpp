// SPDX-License-Identifier: BSD-3-Clause
// The laws of scenes that name effects, put together from policies (docs/architecture.md, "How a law is put together").
//
// A law is the plain one with some of its answers replaced; what an effect does not touch is the plain law's own code, so
// that an effect whose parameters make it none gives the plain law's bits.
#pragma once

#include "carrom/effects/contacts.hpp"
#include "carrom/effects/effects.hpp"
#include "carrom/effects/plain_law.hpp"

namespace carrom {

template <class Contact> class EffectLaw : public PlainLaw {
public:
    static constexpr bool has_pairs = Contact::has_pairs;

    /// `effects` per micro-step.
    EffectLaw(double box_size, double radius, const Effects& effects)
        : PlainLaw(box_size, radius), contact_(effects.contact) {}

    PairContact<double> contact(const Disc& p, const Disc& q) const {
        if constexpr (has_pairs) return PlainLaw::contact(p, q);
        return {};
    }
    PairContact<double> exact_contact(const Disc& p, const Disc& q) const {
        if constexpr (has_pairs) return PlainLaw::exact_contact(p, q);
        return {};
    }

    void collide(Disc& p, Disc& q, double m, double t) const {
        collide_with(p, q, m + t, contact_.impulse());
        stop_at_wall(p, m, t);
        stop_at_wall(q, m, t);
    }
    void collide_at(Disc& p, Disc& q, double time) const { collide_with(p, q, time, contact_.impulse_at(p, q, time)); }

private:
    Contact contact_;
};

using IdealGasLaw = EffectLaw<NoContact>;
using InelasticLaw = EffectLaw<InelasticContact>;

} // namespace carrom
