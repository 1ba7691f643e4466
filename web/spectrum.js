// What two sounds have in their spectra: how loud one is above a frequency, and how far third octaves of two are apart.
function spectrum(samples, size = 16384) {  // powers of the first `size` samples under a Hann window, radix 2
    const re = new Float64Array(size), im = new Float64Array(size), bits = Math.log2(size);
    for (let n = 0; n < size; ++n) {
        let from = 0;
        for (let b = 0; b < bits; ++b) from = from << 1 | (n >> b & 1);
        re[from] = (samples[n] ?? 0) * (0.5 - 0.5 * Math.cos(2 * Math.PI * n / size));
    }
    for (let half = 1; half < size; half *= 2)
        for (let k = 0; k < half; ++k) {
            const c = Math.cos(Math.PI * k / half), s = -Math.sin(Math.PI * k / half);
            for (let i = k; i < size; i += 2 * half) {
                const j = i + half, x = re[j] * c - im[j] * s, y = re[j] * s + im[j] * c;
                re[j] = re[i] - x, im[j] = im[i] - y, re[i] += x, im[i] += y;
            }
        }
    return Float64Array.from({length: size / 2}, (_, k) => re[k] ** 2 + im[k] ** 2);
}
function power_above(samples, hertz, rate) {
    const power = spectrum(samples);
    return power.slice(Math.ceil(hertz * 2 * power.length / rate)).reduce((a, b) => a + b, 0);
}
function third_octaves_apart(a, b, rate) {  // mean difference [dB] of the bands that b has within 60 dB of its loudest
    const [pa, pb] = [a, b].map(x => spectrum(x)), levels = [];
    for (let f = 62.5; f * 2 ** (1 / 6) < 16000; f *= 2 ** (1 / 3)) {
        const bin = 2 * pa.length / rate, [from, to] = [Math.floor(f * 2 ** (-1 / 6) * bin), Math.ceil(f * 2 ** (1 / 6) * bin)], sum = p => p.slice(from, to).reduce((x, y) => x + y, 1e-300);
        levels.push([sum(pa), sum(pb)]);
    }
    const loudest = Math.max(...levels.map(l => l[1])), heard = levels.filter(l => l[1] > 1e-6 * loudest);
    return heard.reduce((sum, [x, y]) => sum + Math.abs(10 * Math.log10(x / y)), 0) / heard.length;
}
