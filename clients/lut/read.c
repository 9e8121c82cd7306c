/* Reads materials and views from standard input, gamma sigma mu a line, and prints the albedo and
   its average as the headers have them. */
#include <stdio.h>

#include "lut.h"
#include "lut_average.h"

int main(void) {
    float gamma, sigma, mu;
    while (scanf("%f %f %f", &gamma, &sigma, &mu) == 3) {
#if defined(VOLUME)
        printf("%.9g %.9g\n", lut_read(gamma, sigma, mu), lut_average_read(gamma, sigma));
#elif defined(HALF)
        float e[2], average[2];
        lut_read(sigma, mu, e);
        lut_average_read(sigma, average);
        printf("%.9g %.9g\n", e[0], average[0]);
#else
        printf("%.9g %.9g\n", lut_read(sigma, mu), lut_average_read(sigma));
#endif
    }
    return 0;
}
