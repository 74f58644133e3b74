// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include <springfit/network/spring_network.hpp>

namespace springfit {

/// The values of a spring that can be fitted; each enters the acceleration linearly.
enum class ParameterKind {
    stiffness, ///< k_e, N/m
    damping,   ///< c_e, N s/m
    preload    ///< q_e = k_e (l_e - l_e^0), N: how far the rest length l_e moves from the given l_e^0, times stiffness
};

inline constexpr std::array<ParameterKind, 3> parameter_kinds{ParameterKind::stiffness, ParameterKind::damping,
                                                              ParameterKind::preload};

/// One kind of unknown. The same bounds hold for every spring; `lower == upper` fixes the kind at that value.
template <ParameterKind Kind>
struct KindOptions {
    bool fit = Kind == ParameterKind::stiffness; ///< false: the network's own value is taken as known
    /// Lower bound; -infinity where there is none.
    double lower = Kind == ParameterKind::preload ? -std::numeric_limits<double>::infinity() : 0;
    double upper = std::numeric_limits<double>::infinity(); ///< upper bound, >= lower
    std::vector<int> ties; ///< group of each spring [n_springs], springs of one group share one value; empty: no ties
    Values<double> prior;  ///< what a spring gets that no motion excites [n_springs]; empty: the network's value
};

/// The unknowns among the springs' values.
struct ParameterOptions {
    KindOptions<ParameterKind::stiffness> stiffness{};
    KindOptions<ParameterKind::damping> damping{};
    KindOptions<ParameterKind::preload> preload{};
    /// beta of Kelvin-Voigt springs, s, >= 0: above 0 every fitted stiffness brings its damping c_e = beta k_e along
    /// (the network's own damping is not used, and damping cannot be fitted besides).
    double damping_per_stiffness = 0;
    /// Weight of `ridge / 2 * h * (theta - prior)^2`, h the mean curvature of the kind; >= 0, 0 switches it off.
    double ridge = 0;
};

/// A value of one spring.
struct SpringParameter {
    ParameterKind kind = ParameterKind::stiffness;
    int spring = 0;
    friend bool operator==(const SpringParameter&, const SpringParameter&) = default;
};

/// The numbering of the unknowns theta: stiffness first, then damping, then preload; one per spring or group of ties.
///
/// A spring whose two ends are fixed in every motion has no unknown and keeps its prior.
class Parameters {
public:
    Parameters() = default;

    /// Numbers every spring or group. Throws InvalidArgument where a size, bound or prior is wrong, or for no unknown.
    template <int Dim, std::floating_point Scalar>
    Parameters(const SpringNetwork<Dim, Scalar>& network, const ParameterOptions& options)
        : m_rest_length(network.rest_length.template cast<double>()),
          m_damping_per_stiffness(options.damping_per_stiffness) {
        require(m_damping_per_stiffness >= 0 && std::isfinite(m_damping_per_stiffness), "damping_per_stiffness",
                "a time not below 0", m_damping_per_stiffness);
        require(m_damping_per_stiffness == 0 || (options.stiffness.fit && !options.damping.fit),
                "damping_per_stiffness", "stiffness fitted and damping not", "another choice of unknowns");
        require(options.ridge >= 0 && std::isfinite(options.ridge), "ridge", "a finite value not below 0",
                options.ridge);
        add_kind(options.stiffness, "stiffness", network.stiffness.template cast<double>());
        add_kind(options.damping, "damping", network.damping.template cast<double>());
        add_kind(options.preload, "preload", Values<double>::Zero(network.n_springs()));
        require(n_unknowns() > 0, "parameters", "at least one unknown", "none");
    }

    [[nodiscard]] Index n_springs() const { return m_rest_length.size(); }
    [[nodiscard]] Index n_unknowns() const { return static_cast<Index>(m_kind.size()); }

    /// True where any value of this kind is to be fitted.
    [[nodiscard]] bool fits(ParameterKind kind) const { return !of(kind).unknown.empty(); }
    /// Number of the unknown of a spring; -1: none.
    [[nodiscard]] int unknown(ParameterKind kind, Index spring) const {
        return fits(kind) ? of(kind).unknown[static_cast<std::size_t>(spring)] : -1;
    }
    [[nodiscard]] ParameterKind kind(Index unknown) const { return m_kind[static_cast<std::size_t>(unknown)]; }

    [[nodiscard]] const Values<double>& lower() const { return m_lower; }
    [[nodiscard]] const Values<double>& upper() const { return m_upper; }
    /// Prior of each unknown, moved into its bounds; of a group, the mean of its springs `[n_unknowns]`.
    [[nodiscard]] const Values<double>& prior() const { return m_prior; }

    /// The value of each spring: theta where it has an unknown, its prior elsewhere `[n_springs]`.
    [[nodiscard]] Values<double> per_spring(ParameterKind kind, const Values<double>& theta) const {
        require(theta.size() == n_unknowns(), "theta", text(n_unknowns(), " values, one per unknown"), theta.size());
        Values<double> values = of(kind).prior;
        for (Index e = 0; e < n_springs(); ++e) {
            if (const int column = unknown(kind, e); column >= 0) {
                values(e) = theta(column);
            }
        }
        return values;
    }

    /// The springs of unknowns, by unknown and then by spring.
    [[nodiscard]] std::vector<SpringParameter> springs(const std::vector<int>& unknowns) const {
        std::vector<int> wanted(m_kind.size(), -1);
        for (int u : unknowns) {
            wanted[static_cast<std::size_t>(u)] = u;
        }
        std::vector<SpringParameter> found;
        for (ParameterKind kind : parameter_kinds) {
            for (Index e = 0; e < n_springs(); ++e) {
                const int column = unknown(kind, e);
                if (column >= 0 && wanted[static_cast<std::size_t>(column)] >= 0) {
                    found.push_back({kind, static_cast<int>(e)});
                }
            }
        }
        return found;
    }

    /// Fitted values that have no unknown, since both ends of their springs are fixed in every motion.
    [[nodiscard]] std::vector<SpringParameter> without_unknown() const {
        std::vector<SpringParameter> found;
        for (ParameterKind kind : parameter_kinds) {
            for (Index e = 0; fits(kind) && e < n_springs(); ++e) {
                if (unknown(kind, e) < 0) {
                    found.push_back({kind, static_cast<int>(e)});
                }
            }
        }
        return found;
    }

    /// Rest lengths that preload is counted from `[n_springs]`, m.
    [[nodiscard]] const Values<double>& rest_length() const { return m_rest_length; }

    /// c_e / k_e of springs whose damping follows their stiffness, s; 0: it does not.
    [[nodiscard]] double damping_per_stiffness() const { return m_damping_per_stiffness; }

    /// The same with the unknowns that `keep` marks, renumbered in order `[n_unknowns]`.
    [[nodiscard]] Parameters subset(const std::vector<bool>& keep) const {
        Parameters result;
        result.m_rest_length = m_rest_length;
        result.m_damping_per_stiffness = m_damping_per_stiffness;
        result.m_kinds = m_kinds;
        std::vector<int> renumbered(m_kind.size(), -1);
        std::vector<int> kept;
        for (std::size_t u = 0; u < m_kind.size(); ++u) {
            if (keep[u]) {
                renumbered[u] = static_cast<int>(kept.size());
                kept.push_back(static_cast<int>(u));
                result.m_kind.push_back(m_kind[u]);
            }
        }
        result.m_lower = m_lower(kept);
        result.m_upper = m_upper(kept);
        result.m_prior = m_prior(kept);
        for (auto& kind : result.m_kinds) {
            for (int& column : kind.unknown) {
                column = column < 0 ? -1 : renumbered[static_cast<std::size_t>(column)];
            }
        }
        return result;
    }

private:
    struct Kind {
        std::vector<int> unknown; ///< per spring; empty: the kind is not fitted
        Values<double> prior;     ///< per spring
    };

    [[nodiscard]] const Kind& of(ParameterKind kind) const { return m_kinds[static_cast<std::size_t>(kind)]; }

    template <ParameterKind K>
    void add_kind(const KindOptions<K>& options, std::string_view name, const Values<double>& given) {
        Kind& kind = m_kinds[static_cast<std::size_t>(K)];
        const Index n = n_springs();
        require(options.prior.size() == 0 || options.prior.size() == n, text(name, " prior"),
                text(n, " values, one per spring"), options.prior.size());
        require(options.prior.allFinite(), text(name, " prior"), "finite values", "a value that is not finite");
        kind.prior = options.fit && options.prior.size() > 0 ? options.prior : given;
        if (!options.fit) {
            return;
        }
        constexpr double infinity = std::numeric_limits<double>::infinity();
        const double lower = options.lower;
        const double upper = options.upper;
        require(lower <= upper && lower < infinity && upper > -infinity, text(name, " bounds"), "lower <= upper",
                text("[", lower, ", ", upper, "]"));
        require(options.ties.empty() || static_cast<Index>(options.ties.size()) == n, text(name, " ties"),
                text(n, " groups, one per spring"), options.ties.size());
        number(options.ties, kind);
        const Index first = m_lower.size();
        const Index total = n_unknowns();
        m_lower.conservativeResize(total);
        m_upper.conservativeResize(total);
        m_prior.conservativeResize(total);
        m_lower.tail(total - first).setConstant(lower);
        m_upper.tail(total - first).setConstant(upper);
        m_prior.tail(total - first).setZero();
        Values<double> members = Values<double>::Zero(total);
        for (Index e = 0; e < n; ++e) {
            m_prior(kind.unknown[static_cast<std::size_t>(e)]) += kind.prior(e);
            members(kind.unknown[static_cast<std::size_t>(e)]) += 1;
        }
        for (Index u = first; u < total; ++u) {
            m_prior(u) = std::clamp(m_prior(u) / members(u), m_lower(u), m_upper(u));
        }
    }

    /// Gives each spring, or each group in ascending order, the next free number of this kind.
    void number(const std::vector<int>& ties, Kind& kind) {
        const auto kind_value = static_cast<ParameterKind>(&kind - m_kinds.data());
        const auto first = static_cast<int>(m_kind.size());
        std::vector<int> groups = ties;
        std::sort(groups.begin(), groups.end());
        groups.erase(std::unique(groups.begin(), groups.end()), groups.end());
        const std::size_t count = ties.empty() ? static_cast<std::size_t>(n_springs()) : groups.size();
        kind.unknown.resize(static_cast<std::size_t>(n_springs()));
        for (std::size_t e = 0; e < kind.unknown.size(); ++e) {
            const auto group = ties.empty() ? static_cast<std::ptrdiff_t>(e)
                                            : std::lower_bound(groups.begin(), groups.end(), ties[e]) - groups.begin();
            kind.unknown[e] = first + static_cast<int>(group);
        }
        m_kind.insert(m_kind.end(), count, kind_value);
    }

    Values<double> m_rest_length;
    double m_damping_per_stiffness = 0;
    std::array<Kind, 3> m_kinds;
    std::vector<ParameterKind> m_kind; ///< per unknown
    Values<double> m_lower, m_upper, m_prior;
};

} // namespace springfit
