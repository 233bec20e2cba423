#include "optim/sparse/assembly_tree.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <numeric>

namespace mmgrasp::detail {
namespace {

constexpr int kSmall = 8;  // fronts with fewer columns are joined even where that stores zeros

using Lists = std::vector<std::vector<int>>;

/// Position of each column in an order of least degree.
std::vector<int> least_degree(const LowerColumns& pattern) {
  const int n = pattern.size();
  Eigen::SparseMatrix<double> graph(n, n);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(2 * pattern.rows.size());
  for (int c = 0; c < n; ++c)
    for (int e = pattern.starts[c]; e < pattern.starts[c + 1]; ++e) entries.emplace_back(pattern.rows[e], c, 1.0);
  graph.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(graph.selfadjointView<Eigen::Lower>(), order);
  // order.indices()[k] is the column that is eliminated k-th.
  std::vector<int> position(n);
  for (int k = 0; k < n; ++k) position[order.indices()[k]] = k;
  return position;
}

/// Row structure of a matrix whose columns stand in a given order: for each row the columns before it.
Lists before_each(const LowerColumns& pattern, const std::vector<int>& position) {
  Lists before(pattern.size());
  for (int c = 0; c < pattern.size(); ++c) {
    for (int e = pattern.starts[c]; e < pattern.starts[c + 1]; ++e) {
      const auto [earlier, later] = std::minmax(position[c], position[pattern.rows[e]]);
      if (earlier != later) before[later].push_back(earlier);
    }
  }
  return before;
}

/// The elimination tree (Liu 1990): the first column that each one's elimination changes; -1 for none.
std::vector<int> elimination_tree(const Lists& before) {
  const int n = static_cast<int>(before.size());
  std::vector<int> parent(n, -1), ancestor(n, -1);
  for (int row = 0; row < n; ++row) {
    for (int column : before[row]) {
      while (column != -1 && column < row) {
        const int next = ancestor[column];
        ancestor[column] = row;
        if (next == -1) parent[column] = row;
        column = next;
      }
    }
  }
  return parent;
}

/// Children before parents, each subtree in one piece: position in that order.
std::vector<int> postorder(const std::vector<int>& parent) {
  const int n = static_cast<int>(parent.size());
  std::vector<int> first(n, -1), next(n, -1), position(n), stack;
  for (int i = n - 1; i >= 0; --i) {
    if (parent[i] < 0) continue;
    next[i] = first[parent[i]];
    first[parent[i]] = i;
  }
  int count = 0;
  for (int root = 0; root < n; ++root) {
    if (parent[root] >= 0) continue;
    stack.push_back(root);
    while (!stack.empty()) {
      const int node = stack.back();
      if (first[node] >= 0) {
        stack.push_back(first[node]);
        first[node] = next[first[node]];
      } else {
        position[node] = count++;
        stack.pop_back();
      }
    }
  }
  return position;
}

/// Non-zeros below the diagonal in each column of the factor.
std::vector<int> column_counts(const Lists& before, const std::vector<int>& parent) {
  const int n = static_cast<int>(before.size());
  std::vector<int> count(n, 0), mark(n, -1);
  for (int row = 0; row < n; ++row) {
    mark[row] = row;
    for (int column : before[row]) {
      for (; mark[column] != row; column = parent[column]) {
        mark[column] = row;
        ++count[column];
      }
    }
  }
  return count;
}

/// Columns that are eliminated together, as a tree of groups.
struct Groups {
  std::vector<int> of;       ///< Group of each column.
  std::vector<int> parent;   ///< Each group's parent; -1: none.
  std::vector<int> columns;  ///< Number of each group's columns.
};

/// Joins each column to the one before it where that has the same rows, then small groups to their parents.
Groups group_columns(const std::vector<int>& parent, const std::vector<int>& count) {
  const int n = static_cast<int>(parent.size());
  std::vector<int> group(n), columns, rows, up;  // rows: below the group's own columns
  for (int c = 0; c < n; ++c) {
    const bool same = c > 0 && parent[c - 1] == c && count[c - 1] == count[c] + 1;
    if (!same) {
      columns.push_back(0);
      rows.push_back(0);
      up.push_back(-1);
    }
    group[c] = static_cast<int>(columns.size()) - 1;
    ++columns[group[c]];
    rows[group[c]] = count[c];
    up[group[c]] = parent[c];  // a column, until all have a group
  }
  const int m = static_cast<int>(columns.size());
  for (int& g : up) g = g < 0 ? -1 : group[g];
  std::vector<int> joined(m);
  std::iota(joined.begin(), joined.end(), 0);
  for (int g = 0; g < m; ++g) {
    if (up[g] < 0) continue;
    // Parents come later: they have not been joined to theirs yet.
    const int p = up[g];
    const bool no_zeros = rows[g] == columns[p] + rows[p];
    if (!no_zeros && (columns[g] >= kSmall || columns[p] >= kSmall)) continue;
    joined[g] = p;
    columns[p] += columns[g];
  }
  for (int g = m - 1; g >= 0; --g) joined[g] = joined[joined[g]];
  Groups out;
  std::vector<int> number(m, -1);
  for (int g = 0; g < m; ++g) {
    if (joined[g] != g) continue;
    number[g] = static_cast<int>(out.columns.size());
    out.columns.push_back(columns[g]);
    out.parent.push_back(up[g]);
  }
  for (int& p : out.parent) p = p < 0 ? -1 : number[joined[p]];
  out.of.resize(n);
  for (int c = 0; c < n; ++c) out.of[c] = number[joined[group[c]]];
  return out;
}

}  // namespace

AssemblyTree::AssemblyTree(const LowerColumns& pattern) : position(least_degree(pattern)) {
  const int n = pattern.size();
  const auto reorder = [&](const std::vector<int>& to) {
    for (int& p : position) p = to[p];
  };
  reorder(postorder(elimination_tree(before_each(pattern, position))));
  const Lists rough = before_each(pattern, position);
  const std::vector<int> parent = elimination_tree(rough);
  const Groups groups = group_columns(parent, column_counts(rough, parent));

  // Groups in an order of their own, the columns of each in one piece.
  const std::vector<int> order = postorder(groups.parent);
  const int m = static_cast<int>(order.size());
  fronts.resize(m);
  for (int g = 0; g < m; ++g) fronts[order[g]].columns = groups.columns[g];
  int at = 0;
  for (Front& front : fronts) {
    front.first = at;
    at += front.columns;
  }
  std::vector<int> taken(m, 0), to(n);
  for (int c = 0; c < n; ++c) {
    const int front = order[groups.of[c]];
    to[c] = fronts[front].first + taken[front]++;
  }
  reorder(to);

  std::vector<int> up(m, -1);
  for (int g = 0; g < m; ++g) {
    if (groups.parent[g] < 0) continue;
    up[order[g]] = order[groups.parent[g]];
    ++fronts[up[order[g]]].children;
  }
  std::vector<int> mark(n, -1), front_of(n);
  for (int f = 0; f < m; ++f)
    for (int c = 0; c < fronts[f].columns; ++c) front_of[fronts[f].first + c] = f;
  Lists own(m);  // rows of the matrix itself
  for (int c = 0; c < n; ++c) {
    for (int e = pattern.starts[c]; e < pattern.starts[c + 1]; ++e) {
      const auto [earlier, later] = std::minmax(position[c], position[pattern.rows[e]]);
      own[front_of[earlier]].push_back(later);
    }
  }
  for (int f = 0; f < m; ++f) {
    Front& front = fronts[f];
    const int end = front.first + front.columns;
    for (int row : own[f]) {
      if (row < end || mark[row] == f) continue;
      mark[row] = f;
      front.rows.push_back(row);
    }
    std::sort(front.rows.begin(), front.rows.end());
    if (up[f] >= 0) own[up[f]].insert(own[up[f]].end(), front.rows.begin(), front.rows.end());
  }
}

}  // namespace mmgrasp::detail
