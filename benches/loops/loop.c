/* The fixed-step loop of the paper's example with four oscillators, written by hand: argv[1] steps of 1e-4. */
#define _POSIX_C_SOURCE 199309L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#define N_O 4
#define D (3 + 1 + 2 * N_O)

static const double two_pi = 6.283185307179586476925;
static double weight[N_O + 1];
static double frequency[N_O + 1];

static void right_side(double t, const double *y, double *dy)
{
    const double sigma = 2.0, mu = 1.0;
    const double x1 = y[0], x2 = y[1], e = y[2];
    const double *z = y + 3;
    const double c = cos(two_pi * t);
    double s = weight[0] * (z[0] - e);
    int l;

    dy[0] = -x1 / 5 + sqrt(3.0) * x2 + sin(x2) / 10 + sin(two_pi * t);
    dy[1] = -sqrt(3.0) * x1 - x2 + x2 * x2 / 10 + x2 * e + cos(2 * two_pi * t) * (1 + sin(two_pi * t));
    dy[3] = -sigma * e;
    for (l = 1; l <= N_O; l++) {
        const double a = z[2 * l - 1], b = z[2 * l];
        s += weight[l] * (a - e);
        dy[3 + 2 * l - 1] = frequency[l] * b - sigma * e;
        dy[3 + 2 * l] = frequency[l] * (e - a);
    }
    dy[2] = 1 + x1 + atan(e * x2) + c + c * c + c * c * c + c * c * c * c - sigma * e + mu * s;
}

int main(int argc, char **argv)
{
    const long steps = argc > 1 ? atol(argv[1]) : 1;
    const double h = 1e-4;
    double y[D] = {1.0, -2.0, 4.0}, k1[D], k2[D], k3[D], k4[D], m[D];
    struct timespec start, end;
    long step;
    int i, l;

    for (l = 0; l <= N_O; l++) {
        weight[l] = l == 0 ? 2.0 : pow(l, -1.5);
        frequency[l] = l * two_pi;
    }
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &start);
    for (step = 0; step < steps; step++) {
        const double t = step % 10000 * h;
        right_side(t, y, k1);
        for (i = 0; i < D; i++) m[i] = y[i] + 0.5 * h * k1[i];
        right_side(t + 0.5 * h, m, k2);
        for (i = 0; i < D; i++) m[i] = y[i] + 0.5 * h * k2[i];
        right_side(t + 0.5 * h, m, k3);
        for (i = 0; i < D; i++) m[i] = y[i] + h * k3[i];
        right_side(t + h, m, k4);
        for (i = 0; i < D; i++) y[i] += h / 6 * (k1[i] + 2 * (k2[i] + k3[i]) + k4[i]);
    }
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &end);
    printf("%.9f %.17g\n", (end.tv_sec - start.tv_sec) + 1e-9 * (end.tv_nsec - start.tv_nsec), y[2]);
    return 0;
}
