# SPDX-License-Identifier: AGPL-3.0-or-later
# Times at equal error: each method's lower envelope, straight lines between its points in a plot of log time against
# log error. A point counts if no other of its method is both faster and closer.

# Fills E[1..n], T[1..n] of a scene's method, errors falling and times rising; what: "total" or "shadow".
function envelope(scene, method, what, E, T,  i, j, n, m, e, t, worse, X, Y) {
  n = 0
  for (i = 1; i <= count; i++)
    if (index(names[i], "speed/" scene "/" method "/") == 1 && has(names[i], "rmse") && get(names[i], "rmse") > 0) {
      X[++n] = get(names[i], "rmse") + 0
      Y[n] = what == "total" ? get(names[i], "seconds") + 0 : shadow_seconds(names[i])
    }
  m = 0
  for (i = 1; i <= n; i++) {
    worse = 0
    for (j = 1; j <= n; j++) if (j != i && X[j] <= X[i] && Y[j] <= Y[i] && (X[j] < X[i] || Y[j] < Y[i] || j < i)) worse = 1
    if (worse) continue
    e = X[i]; t = Y[i]
    for (j = m; j >= 1 && E[j] < e; j--) { E[j + 1] = E[j]; T[j + 1] = T[j] }
    E[j + 1] = e; T[j + 1] = t
    m++
  }
  return m
}

# Seconds at an error; "" where the method does not get there. Beyond its coarsest point it takes no longer than there.
function time_at(e, E, T, n,  i, f) {
  if (n == 0 || e < E[n] * 0.99999) return ""
  if (e >= E[1]) return T[1]
  for (i = 1; i < n && e < E[i + 1]; i++) ;
  if (i == n) return T[n]
  f = log(E[i] / e) / log(E[i] / E[i + 1])
  return exp(log(T[i]) + f * log(T[i + 1] / T[i]))
}

# The range of errors that both of two envelopes reach: sets lo and hi; 0 if there is none.
function common(E, n, F, m) {
  if (n == 0 || m == 0) return 0
  lo = E[n] > F[m] ? E[n] : F[m]
  hi = E[1] < F[1] ? E[1] : F[1]
  return lo <= (E[1] > F[1] ? E[1] : F[1])
}
