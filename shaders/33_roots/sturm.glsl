// The roots of a polynomial by Sturm's theorem, as with POV-Ray's keyword `sturm` (D. G. Hook and P. R. McAree,
// Using Sturm Sequences to Bracket Real Roots of Polynomial Equations, Graphics Gems, 1990).
//
// The chain begins with the polynomial and its derivative; each further member is the remainder of the two before it,
// with the opposite sign. The signs of the chain's members change v(x) times from the first to the last. Between low
// and high the polynomial has v(low) - v(high) different roots.

struct Sturm {
    Quartic member[5];
    int count;
};

// ANCHOR: chain
// The degree of q, below `most`: the highest whose coefficient is not 0.
int degree_below(Quartic q, int most) {
    int degree = most - 1;
    while (degree > 0 && q.c[degree] == 0.0) {
        degree--;
    }
    return degree;
}

// The remainder of a divided by b, of degree `n` and `m`, with the opposite sign and its largest coefficient 1.
Quartic negative_remainder(Quartic a, int n, Quartic b, int m) {
    for (int i = n; i >= m; i--) {
        precise float factor = a.c[i] / b.c[m];
        for (int k = 0; k <= m; k++) {
            precise float rest = a.c[i - m + k] - factor * b.c[k];
            a.c[i - m + k] = rest;
        }
        a.c[i] = 0.0;
    }
    float largest = 0.0;
    for (int k = 0; k < m; k++) {
        largest = max(largest, abs(a.c[k]));
    }
    for (int k = 0; k < m; k++) {
        a.c[k] = largest > 0.0 ? -a.c[k] / largest : 0.0;
    }
    return a;
}

Sturm sturm_chain(Quartic q) {
    Sturm chain;
    chain.member[0] = q;
    chain.member[1] = derivative(q);
    chain.count = 2;
    int n = 4;
    int m = degree_below(chain.member[1], 4);
    // A remainder that is 0 ends the chain: then q has multiple roots, and counts each once.
    for (int i = 2; i < 5; i++) {
        if (m == 0) {
            break;
        }
        Quartic next = negative_remainder(chain.member[i - 2], n, chain.member[i - 1], m);
        n = m;
        m = degree_below(next, m);
        if (next.c[m] == 0.0) {
            break;
        }
        chain.member[i] = next;
        chain.count = i + 1;
    }
    return chain;
}

int sign_changes(Sturm chain, float x) {
    int changes = 0;
    float before = 0.0;
    for (int i = 0; i < chain.count; i++) {
        float y = value(chain.member[i], x);
        if (y != 0.0) {
            changes += before * sign(y) < 0.0 ? 1 : 0;
            before = sign(y);
        }
    }
    return changes;
}
// ANCHOR_END: chain

// ANCHOR: bisect
// The first root between `low` and `high`: the half that has it is halved again.
bool first_by_sturm(Quartic q, float low, float high, out float x) {
    Sturm chain = sturm_chain(q);
    int at_low = sign_changes(chain, low);
    x = high;
    if (at_low <= sign_changes(chain, high)) {
        return false;
    }
    for (int i = 0; i < 40; i++) {
        precise float middle = 0.5 * (low + high);
        if (!(middle > low && middle < high)) {
            break;
        }
        if (at_low > sign_changes(chain, middle)) {
            high = middle;
        } else {
            low = middle;
        }
    }
    x = high;
    return true;
}
// ANCHOR_END: bisect
