// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>
#include <vector>

#include <springfit/core/types.hpp>

namespace springfit::detail {

/// Items 0 to n - 1 by decreasing key, the lower item first among equals; keys of those still in it may change.
class IndexedHeap {
public:
    /// Puts all items in. O(n).
    void fill(const std::vector<double>& keys) {
        m_keys = keys;
        m_heap.resize(keys.size());
        m_place.resize(keys.size());
        for (std::size_t i = 0; i < keys.size(); ++i) {
            m_heap[i] = static_cast<int>(i);
            m_place[i] = static_cast<int>(i);
        }
        for (std::size_t i = m_heap.size() / 2; i-- > 0;) {
            down(i);
        }
    }

    [[nodiscard]] bool empty() const { return m_heap.empty(); }

    /// Takes out the item of the largest key. O(log n).
    int pop() {
        const int top = m_heap.front();
        swap(0, m_heap.size() - 1);
        m_heap.pop_back();
        m_place[static_cast<std::size_t>(top)] = -1;
        if (!m_heap.empty()) {
            down(0);
        }
        return top;
    }

    /// Changes the key of an item; nothing moves where it was taken out already. O(log n).
    void update(int item, double key) {
        const auto i = static_cast<std::size_t>(item);
        m_keys[i] = key;
        if (m_place[i] >= 0) {
            up(static_cast<std::size_t>(m_place[i]));
            down(static_cast<std::size_t>(m_place[i]));
        }
    }

    [[nodiscard]] double key(int item) const { return m_keys[static_cast<std::size_t>(item)]; }

private:
    [[nodiscard]] bool before(std::size_t a, std::size_t b) const {
        const auto i = static_cast<std::size_t>(m_heap[a]);
        const auto j = static_cast<std::size_t>(m_heap[b]);
        return m_keys[i] > m_keys[j] || (m_keys[i] == m_keys[j] && i < j);
    }
    void swap(std::size_t a, std::size_t b) {
        std::swap(m_heap[a], m_heap[b]);
        m_place[static_cast<std::size_t>(m_heap[a])] = static_cast<int>(a);
        m_place[static_cast<std::size_t>(m_heap[b])] = static_cast<int>(b);
    }
    void up(std::size_t at) {
        while (at > 0 && before(at, (at - 1) / 2)) {
            swap(at, (at - 1) / 2);
            at = (at - 1) / 2;
        }
    }
    void down(std::size_t at) {
        while (true) {
            std::size_t best = at;
            for (std::size_t child = 2 * at + 1; child <= 2 * at + 2 && child < m_heap.size(); ++child) {
                best = before(child, best) ? child : best;
            }
            if (best == at) {
                return;
            }
            swap(at, best);
            at = best;
        }
    }

    std::vector<double> m_keys;
    std::vector<int> m_heap;
    std::vector<int> m_place; ///< where an item lies in the heap; -1: taken out
};

} // namespace springfit::detail
