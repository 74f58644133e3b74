// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <limits>

#include <springfit/network/spring_network.hpp>

namespace springfit {

/// The values that matching of motion can fit.
enum class MotionParameter {
    stiffness,   ///< k_e = k_e^0 exp(theta)
    damping,     ///< c_e = c_e^0 exp(theta)
    rest_length, ///< l_e = l_e^0 exp(s theta), s = `rest_length_scale`
    volume       ///< kappa_c = kappa_c^0 + mu theta, mu the shear modulus of the springs; of either sign
};

[[nodiscard]] constexpr std::string_view to_string(MotionParameter kind) {
    switch (kind) {
    case MotionParameter::stiffness: return "stiffness";
    case MotionParameter::damping: return "damping";
    case MotionParameter::rest_length: return "rest_length";
    case MotionParameter::volume: return "volume_stiffness";
    }
    return "unknown";
}

/// One kind of unknown of `TrajectoryProblem`.
struct MotionParameterOptions {
    bool fit = false;
    double lower = -std::numeric_limits<double>::infinity(); ///< bound of the value itself, in its unit
    double upper = std::numeric_limits<double>::infinity();  ///< >= lower
    /// Group of each spring or cell: those of one group share one theta, so one factor on what they start from (one
    /// value, where they start from the same); empty: no ties.
    std::vector<int> ties{};
};

/// The unknown values, and the meaning of theta. The network's own values are the prior, theta = 0.
struct TrajectoryParameterOptions {
    MotionParameterOptions stiffness{.fit = true};
    MotionParameterOptions damping{};
    MotionParameterOptions rest_length{};
    MotionParameterOptions volume{.fit = true}; ///< of networks with cells
    /// beta of Kelvin-Voigt springs, s, >= 0: above 0 damping follows stiffness, c_e = beta k_e, and is not fitted.
    double damping_per_stiffness = 0;
    bool fit_damping_per_stiffness = false; ///< beta > 0 is where one more unknown starts from: beta exp(theta)
    /// A spring whose prior stiffness (or damping) is below this part of the mean starts from that: the logarithm needs
    /// a positive value. In (0, 1].
    double least_prior = 0.02;
    double rest_length_scale = 0.02; ///< s > 0: the relative change of a rest length at theta = 1
};

/// A value for each spring and each cell: the derivative by, or a change of, what a network is made of.
struct NetworkValues {
    Values<double> stiffness;        ///< [n_springs]
    Values<double> damping;          ///< [n_springs]
    Values<double> rest_length;      ///< [n_springs]
    Values<double> volume_stiffness; ///< [n_cells]

    static NetworkValues zero(Index n_springs, Index n_cells) {
        const Values<double> springs = Values<double>::Zero(n_springs);
        return {springs, springs, springs, Values<double>::Zero(n_cells)};
    }

    NetworkValues& operator+=(const NetworkValues& other) {
        stiffness += other.stiffness;
        damping += other.damping;
        rest_length += other.rest_length;
        volume_stiffness += other.volume_stiffness;
        return *this;
    }
};

/// The map from the unknowns theta `[n_unknowns]` to a network, and its derivative. theta = 0 is the prior.
template <int Dim>
class TrajectoryParameters {
public:
    using Network = SpringNetwork<Dim, double>;

    TrajectoryParameters() = default;

    /// Throws InvalidArgument for a network or option that cannot be used, or for no unknown.
    TrajectoryParameters(Network network, const TrajectoryParameterOptions& options)
        : m_prior(std::move(network)), m_rest_length_scale(options.rest_length_scale),
          m_beta(options.damping_per_stiffness) {
        validate(m_prior);
        require(m_rest_length_scale > 0 && std::isfinite(m_rest_length_scale), "rest_length_scale",
                "a positive relative length", m_rest_length_scale);
        require(options.least_prior > 0 && options.least_prior <= 1, "least_prior", "a part in (0, 1]",
                options.least_prior);
        require(m_beta >= 0 && std::isfinite(m_beta), "damping_per_stiffness", "a time not below 0", m_beta);
        require(m_beta == 0 || !options.damping.fit, "damping_per_stiffness", "damping that is not fitted besides",
                "both");
        require(m_beta > 0 || !options.fit_damping_per_stiffness, "damping_per_stiffness",
                "a positive time, where it is fitted", m_beta);
        if (options.stiffness.fit) {
            raise(m_prior.stiffness, options.least_prior, "stiffness");
        }
        if (options.damping.fit) {
            raise(m_prior.damping, options.least_prior, "damping");
        }
        if (m_beta > 0) {
            m_prior.damping = m_beta * m_prior.stiffness;
        }
        double energy = 0; // of a uniform stretch by 1, twice
        for (Index e = 0; e < m_prior.n_springs(); ++e) {
            energy += m_prior.stiffness(e) * m_prior.rest_length(e) * m_prior.rest_length(e);
        }
        m_shear_modulus = m_prior.n_cells() > 0 ? energy / (Dim * (Dim + 2) * m_prior.rest_volume.sum()) : 1.;
        number(MotionParameter::stiffness, options.stiffness, m_prior.n_springs());
        number(MotionParameter::damping, options.damping, m_prior.n_springs());
        number(MotionParameter::rest_length, options.rest_length, m_prior.n_springs());
        number(MotionParameter::volume, options.volume, m_prior.n_cells());
        if (options.fit_damping_per_stiffness) {
            m_unknown_beta = static_cast<int>(m_n_unknowns++);
        }
        require(n_unknowns() > 0, "parameters", "at least one unknown", "none");
        set_bounds(MotionParameter::stiffness, options.stiffness);
        set_bounds(MotionParameter::damping, options.damping);
        set_bounds(MotionParameter::rest_length, options.rest_length);
        set_bounds(MotionParameter::volume, options.volume);
    }

    [[nodiscard]] Index n_unknowns() const { return m_n_unknowns; }
    [[nodiscard]] const Network& prior() const { return m_prior; }
    [[nodiscard]] const Values<double>& lower() const { return m_lower; } ///< of theta; 0 may lie outside
    [[nodiscard]] const Values<double>& upper() const { return m_upper; }

    /// Number of the unknown of a spring or cell; -1 where the kind is not fitted.
    [[nodiscard]] int unknown(MotionParameter kind, Index item) const {
        const auto& numbers = of(kind);
        return numbers.empty() ? -1 : numbers[static_cast<std::size_t>(item)];
    }

    /// The network of theta. O(springs + cells).
    [[nodiscard]] Network network(const Values<double>& theta) const {
        require(theta.size() == n_unknowns(), "theta", text(n_unknowns(), " values, one per unknown"), theta.size());
        Network network = m_prior;
        for (MotionParameter kind : kinds) {
            Values<double>& values = values_of(kind, network);
            for (Index item = 0; item < values.size(); ++item) {
                if (const int u = unknown(kind, item); u >= 0) {
                    values(item) = value(kind, values(item), theta(u));
                }
            }
        }
        if (m_beta > 0) {
            network.damping = damping_per_stiffness(theta) * network.stiffness;
        }
        return network;
    }

    /// beta of c_e = beta k_e at theta, s; 0 where damping does not follow stiffness.
    [[nodiscard]] double damping_per_stiffness(const Values<double>& theta) const {
        return m_unknown_beta < 0 ? m_beta : m_beta * std::exp(theta(m_unknown_beta));
    }

    /// The change of the network's values along `direction` `[n_unknowns]` at the network of theta.
    [[nodiscard]] NetworkValues change(const Network& network, const Values<double>& direction) const {
        auto change = NetworkValues::zero(network.n_springs(), network.n_cells());
        for (MotionParameter kind : kinds) {
            Values<double>& values = values_of(kind, change);
            for (Index item = 0; item < values.size(); ++item) {
                if (const int u = unknown(kind, item); u >= 0) {
                    values(item) = slope(kind, network, item) * direction(u);
                }
            }
        }
        if (m_beta > 0) {
            change.damping = beta_of(network) * change.stiffness;
        }
        if (m_unknown_beta >= 0) {
            change.damping += direction(m_unknown_beta) * network.damping;
        }
        return change;
    }

    /// The derivative by theta `[n_unknowns]` from that by the network's values: the transpose of `change`.
    [[nodiscard]] Values<double> pull_back(const Network& network, NetworkValues derivative) const {
        Values<double> result = Values<double>::Zero(n_unknowns());
        if (m_beta > 0) {
            derivative.stiffness += beta_of(network) * derivative.damping;
        }
        if (m_unknown_beta >= 0) {
            result(m_unknown_beta) = network.damping.dot(derivative.damping);
        }
        for (MotionParameter kind : kinds) {
            const Values<double>& values = values_of(kind, derivative);
            for (Index item = 0; item < values.size(); ++item) {
                if (const int u = unknown(kind, item); u >= 0) {
                    result(u) += slope(kind, network, item) * values(item);
                }
            }
        }
        return result;
    }

    /// theta of the prior with all fitted stiffness, and fitted volume stiffness, times a factor > 0 [n_unknowns].
    [[nodiscard]] Values<double> uniform_stiffness(double factor) const {
        Values<double> theta = Values<double>::Zero(n_unknowns());
        for (MotionParameter kind : {MotionParameter::stiffness, MotionParameter::volume}) {
            const Values<double>& values = values_of(kind, m_prior);
            for (Index item = 0; item < values.size(); ++item) {
                if (const int u = unknown(kind, item); u >= 0) {
                    theta(u) = theta_of(kind, values(item), factor * values(item));
                }
            }
        }
        return theta;
    }

    /// d value / d theta of a spring or cell of the network of theta.
    [[nodiscard]] double slope(MotionParameter kind, const Network& network, Index item) const {
        switch (kind) {
        case MotionParameter::stiffness: return network.stiffness(item);
        case MotionParameter::damping: return network.damping(item);
        case MotionParameter::rest_length: return m_rest_length_scale * network.rest_length(item);
        case MotionParameter::volume: return m_shear_modulus;
        }
        return 0;
    }

    static constexpr std::array<MotionParameter, 4> kinds{MotionParameter::stiffness, MotionParameter::damping,
                                                          MotionParameter::rest_length, MotionParameter::volume};

private:
    /// beta of a network that `network` returned.
    [[nodiscard]] double beta_of(const Network& network) const {
        return m_unknown_beta < 0 ? m_beta : network.damping.sum() / network.stiffness.sum();
    }

    [[nodiscard]] const std::vector<int>& of(MotionParameter kind) const {
        return m_unknown[static_cast<std::size_t>(kind)];
    }

    template <class Owner>
    static auto& values_of(MotionParameter kind, Owner& owner) {
        switch (kind) {
        case MotionParameter::stiffness: return owner.stiffness;
        case MotionParameter::damping: return owner.damping;
        case MotionParameter::rest_length: return owner.rest_length;
        case MotionParameter::volume: break;
        }
        return owner.volume_stiffness;
    }

    [[nodiscard]] double value(MotionParameter kind, double prior, double theta) const {
        switch (kind) {
        case MotionParameter::rest_length: return prior * std::exp(m_rest_length_scale * theta);
        case MotionParameter::volume: return prior + m_shear_modulus * theta;
        default: return prior * std::exp(theta);
        }
    }

    [[nodiscard]] double theta_of(MotionParameter kind, double prior, double value) const {
        switch (kind) {
        case MotionParameter::rest_length: return std::log(std::max(value, 0.) / prior) / m_rest_length_scale;
        case MotionParameter::volume: return (value - prior) / m_shear_modulus;
        default: return std::log(std::max(value, 0.) / prior);
        }
    }

    static void raise(Values<double>& values, double least, std::string_view name) {
        const double mean = values.size() > 0 ? values.mean() : 0.;
        require(mean > 0, name, "a prior with positive values, as of a closed form", "zeros");
        values = values.cwiseMax(least * mean);
    }

    void number(MotionParameter kind, const MotionParameterOptions& options, Index n) {
        if (!options.fit || n == 0) {
            return;
        }
        const std::string name(to_string(kind));
        require(options.ties.empty() || static_cast<Index>(options.ties.size()) == n, name + " ties",
                text(n, " groups"), options.ties.size());
        auto& numbers = m_unknown[static_cast<std::size_t>(kind)];
        std::vector<int> groups = options.ties;
        std::sort(groups.begin(), groups.end());
        groups.erase(std::unique(groups.begin(), groups.end()), groups.end());
        for (Index item = 0; item < n; ++item) {
            const auto group = options.ties.empty() ? item
                                                    : std::lower_bound(groups.begin(), groups.end(),
                                                                       options.ties[static_cast<std::size_t>(item)]) -
                                                          groups.begin();
            numbers.push_back(static_cast<int>(m_n_unknowns + group));
        }
        m_n_unknowns += options.ties.empty() ? n : static_cast<Index>(groups.size());
    }

    void set_bounds(MotionParameter kind, const MotionParameterOptions& options) {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        require(options.lower <= options.upper, text(to_string(kind), " bounds"), "lower <= upper",
                text("[", options.lower, ", ", options.upper, "]"));
        const Index before = m_lower.size();
        m_lower.conservativeResize(m_n_unknowns);
        m_upper.conservativeResize(m_n_unknowns);
        if (before == 0) {
            m_lower.setConstant(-infinity);
            m_upper.setConstant(infinity);
        }
        const Values<double>& values = values_of(kind, m_prior);
        for (Index item = 0; item < values.size(); ++item) {
            if (const int u = unknown(kind, item); u >= 0) {
                m_lower(u) = std::max(m_lower(u), theta_of(kind, values(item), options.lower));
                m_upper(u) = std::min(m_upper(u), theta_of(kind, values(item), options.upper));
                require(m_lower(u) <= m_upper(u), text(to_string(kind), " bounds"), "a range that all ties can share",
                        text("none for item ", item));
            }
        }
    }

    Network m_prior;
    double m_rest_length_scale = 1;
    double m_beta = 0;
    int m_unknown_beta = -1;
    double m_shear_modulus = 1;
    std::array<std::vector<int>, 4> m_unknown;
    Index m_n_unknowns = 0;
    Values<double> m_lower, m_upper;
};

} // namespace springfit
