// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <springfit/motion/record_static.hpp>

namespace springfit {

/// A reference as the recording of load cases sees it, whatever simulates it: virtual calls once per case.
///
/// `ReferenceRecorder` makes one of any model of the concept Reference, `fem_recorder` of a mesh and a material.
template <int Dim, std::floating_point Scalar>
class CaseRecorder {
public:
    using Scenarios = std::vector<Scenario<Dim, Scalar>>;
    using Recordings = std::vector<Recording<Dim, Scalar>>;

    virtual ~CaseRecorder() = default;

    /// True where forces are linear in the displacement, however large: a model that is true at small strain alone.
    [[nodiscard]] virtual bool is_linear() const { return false; }
    /// True where `linear_responses` and `record_statics` may be called.
    [[nodiscard]] virtual bool finds_equilibria() const = 0;
    /// True where `record` heeds the damping that it is told.
    [[nodiscard]] virtual bool takes_damping() const = 0;
    /// beta of its own damping D = beta K, s, as far as it is known; else 0.
    [[nodiscard]] virtual Scalar stiffness_damping() const = 0;

    /// K u = f_ext at rest: one displacement `[Dim x n_nodes]` per scenario, m; empty where its clamps do not hold the
    /// body.
    [[nodiscard]] virtual std::vector<Points<Dim, Scalar>>
    linear_responses(const Scenarios& scenarios, const StaticRecordOptions<Scalar>& options) const = 0;

    /// The motion under a scenario, with damping D = beta K where it can be told.
    [[nodiscard]] virtual Recording<Dim, Scalar> record(const Scenario<Dim, Scalar>& scenario, Scalar beta,
                                                        const RecordOptions<Scalar>& options) const = 0;

    /// The equilibrium under each scenario; a case that finds none has no frame.
    [[nodiscard]] virtual Recordings record_statics(const Scenarios& scenarios,
                                                    const StaticRecordOptions<Scalar>& options) const = 0;

protected:
    CaseRecorder() = default;
    CaseRecorder(const CaseRecorder&) = default;
    CaseRecorder(CaseRecorder&&) = default;
    CaseRecorder& operator=(const CaseRecorder&) = default;
    CaseRecorder& operator=(CaseRecorder&&) = default;
};

/// Any model of the concept Reference as a CaseRecorder; equilibria where it is a StaticReference as well. The
/// reference must outlive it, and is asked for several cases at the same time.
template <Reference R>
class ReferenceRecorder final : public CaseRecorder<decltype(make_stepper(std::declval<const R&>()))::dimension,
                                                    typename decltype(make_stepper(std::declval<const R&>()))::Scalar> {
public:
    using StepperOf = decltype(make_stepper(std::declval<const R&>()));
    static constexpr int dimension = StepperOf::dimension;
    using Scalar = typename StepperOf::Scalar;
    using Base = CaseRecorder<dimension, Scalar>;

    explicit ReferenceRecorder(const R& reference) : m_reference(&reference) {}

    [[nodiscard]] bool is_linear() const override {
        if constexpr (requires { R::is_linear; }) {
            return R::is_linear;
        } else {
            return false;
        }
    }
    [[nodiscard]] bool finds_equilibria() const override { return StaticReference<R>; }
    [[nodiscard]] bool takes_damping() const override { return false; }
    [[nodiscard]] Scalar stiffness_damping() const override {
        if constexpr (requires { m_reference->options().stiffness_damping; }) {
            return m_reference->options().stiffness_damping;
        } else {
            return 0;
        }
    }

    [[nodiscard]] std::vector<Points<dimension, Scalar>>
    linear_responses(const typename Base::Scenarios& scenarios,
                     const StaticRecordOptions<Scalar>& options) const override {
        if constexpr (StaticReference<R>) {
            return springfit::linear_responses(*m_reference, scenarios, options);
        } else {
            throw InvalidArgument("reference", "a StaticReference", "one that moves in time alone");
        }
    }

    [[nodiscard]] Recording<dimension, Scalar> record(const Scenario<dimension, Scalar>& scenario, Scalar /*beta*/,
                                                      const RecordOptions<Scalar>& options) const override {
        return springfit::record(*m_reference, scenario, options);
    }

    [[nodiscard]] typename Base::Recordings record_statics(const typename Base::Scenarios& scenarios,
                                                           const StaticRecordOptions<Scalar>& options) const override {
        if constexpr (StaticReference<R>) {
            return springfit::record_statics(*m_reference, scenarios, options);
        } else {
            throw InvalidArgument("reference", "a StaticReference", "one that moves in time alone");
        }
    }

private:
    const R* m_reference;
};

} // namespace springfit
