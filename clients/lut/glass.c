/* Reads materials and views from standard input, eta sigma mu a line, and prints the shares that
   are reflected and transmitted and their averages as the headers have them: from inside for
   eta < 1. */
#include <stdio.h>

#include "lut_inside.h"
#include "lut_inside_average.h"
#include "lut_outside.h"
#include "lut_outside_average.h"

int main(void) {
    float eta, sigma, mu, both[2], average[2];
    while (scanf("%f %f %f", &eta, &sigma, &mu) == 3) {
        if (eta < 1.0f) {
            lut_inside_read(eta, sigma, mu, both);
            lut_inside_average_read(eta, sigma, average);
        } else {
            lut_outside_read(eta, sigma, mu, both);
            lut_outside_average_read(eta, sigma, average);
        }
        printf("%.9g %.9g %.9g %.9g\n", both[0], both[1], average[0], average[1]);
    }
    return 0;
}
