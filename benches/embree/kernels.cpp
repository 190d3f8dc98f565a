// Embree 3 on the meshes and rays of `cargo xtask bench kernels`: makes the ray sets, and measures.
//
//   kernels rays MESH.ply PREFIX EDGE EX EY EZ  AX AY AZ  TANGENT  LX LY LZ  HALF  LIFT
//       writes PREFIX.primary, .bounce1, .bounce2 and .shadow: EDGE x EDGE rays each, from the eye E that looks at A with a picture
//       of half width TANGENT at distance 1; shadow rays go to a square light of half edge HALF around L; rays that leave a surface
//       begin LIFT above it.
//   kernels measure MESH.ply PREFIX default|robust ROUNDS
//       prints `key value` lines: million rays per CPU second on one thread, medians of ROUNDS.
//
// A ray in a file is eight little-endian floats: origin, direction, largest distance, expected distance (infinite where nothing is
// hit; for a shadow ray 0 where it is blocked). The expected ones are those of robust mode.

#include <embree3/rtcore.h>

#include <pmmintrin.h>
#include <xmmintrin.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string>
#include <vector>

namespace {

[[noreturn]] void fail(const std::string& reason) {
    std::fprintf(stderr, "error: %s\n", reason.c_str());
    std::exit(1);
}

struct Vector {
    float x, y, z;
};

Vector operator+(Vector a, Vector b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vector operator-(Vector a, Vector b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vector operator*(Vector a, float s) { return {a.x * s, a.y * s, a.z * s}; }
float dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vector cross(Vector a, Vector b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
Vector normalized(Vector a) { return a * (1.0f / std::sqrt(dot(a, a))); }

struct Ray {
    Vector origin, direction;
    float largest, expected;
};
static_assert(sizeof(Ray) == 32, "a ray is eight floats");

struct Mesh {
    std::vector<float> corners;  // one float more than corners need: Embree reads 16 bytes at the last
    std::vector<uint32_t> triangles;
    size_t corner_count = 0, triangle_count = 0;
};

// The binary PLY that xtask/src/bench/mesh_file.rs writes, and no other.
Mesh read_mesh(const char* path) {
    FILE* file = std::fopen(path, "rb");
    if (!file) fail(std::string("cannot open ") + path);
    Mesh mesh;
    char line[256];
    for (;;) {
        if (!std::fgets(line, sizeof line, file)) fail("the mesh has no end_header");
        std::sscanf(line, "element vertex %zu", &mesh.corner_count);
        std::sscanf(line, "element face %zu", &mesh.triangle_count);
        if (std::strncmp(line, "end_header", 10) == 0) break;
    }
    mesh.corners.resize(3 * mesh.corner_count + 1);
    mesh.triangles.resize(3 * mesh.triangle_count);
    if (std::fread(mesh.corners.data(), 12, mesh.corner_count, file) != mesh.corner_count) fail("the mesh is cut short");
    std::vector<unsigned char> faces(13 * mesh.triangle_count);
    if (std::fread(faces.data(), 13, mesh.triangle_count, file) != mesh.triangle_count) fail("the mesh is cut short");
    for (size_t i = 0; i < mesh.triangle_count; i++) std::memcpy(&mesh.triangles[3 * i], &faces[13 * i + 1], 12);
    std::fclose(file);
    return mesh;
}

void write_rays(const std::string& path, const std::vector<Ray>& rays) {
    FILE* file = std::fopen(path.c_str(), "wb");
    if (!file || std::fwrite(rays.data(), sizeof(Ray), rays.size(), file) != rays.size()) fail("cannot write " + path);
    std::fclose(file);
}

std::vector<Ray> read_rays(const std::string& path) {
    FILE* file = std::fopen(path.c_str(), "rb");
    if (!file) fail("cannot open " + path);
    std::fseek(file, 0, SEEK_END);
    std::vector<Ray> rays(std::ftell(file) / sizeof(Ray));
    std::rewind(file);
    if (std::fread(rays.data(), sizeof(Ray), rays.size(), file) != rays.size()) fail("cannot read " + path);
    std::fclose(file);
    return rays;
}

double wall_seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double cpu_seconds(clockid_t clock) {
    timespec time;
    clock_gettime(clock, &time);
    return time.tv_sec + 1e-9 * time.tv_nsec;
}

std::atomic<int64_t> bytes{0};

bool count_memory(void*, ssize_t change, bool) {
    bytes += change;
    return true;
}

struct Built {
    RTCDevice device;
    RTCScene scene;
    double wall, cpu;
};

Built build(Mesh& mesh, bool robust, int threads) {
    bytes = 0;
    RTCDevice device = rtcNewDevice(("threads=" + std::to_string(threads)).c_str());
    if (!device) fail("Embree has no device");
    rtcSetDeviceMemoryMonitorFunction(device, count_memory, nullptr);
    RTCScene scene = rtcNewScene(device);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh.corners.data(), 0, 12,
                               mesh.corner_count);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles.data(), 0, 12,
                               mesh.triangle_count);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    if (robust) rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    double wall = wall_seconds(), cpu = cpu_seconds(CLOCK_PROCESS_CPUTIME_ID);
    rtcCommitScene(scene);
    return {device, scene, wall_seconds() - wall, cpu_seconds(CLOCK_PROCESS_CPUTIME_ID) - cpu};
}

void release(const Built& built) {
    rtcReleaseScene(built.scene);
    rtcReleaseDevice(built.device);
}

void set(RTCRay& to, const Ray& from) {
    to.org_x = from.origin.x;
    to.org_y = from.origin.y;
    to.org_z = from.origin.z;
    to.dir_x = from.direction.x;
    to.dir_y = from.direction.y;
    to.dir_z = from.direction.z;
    to.tnear = 0;
    to.tfar = from.largest;
    to.time = 0;
    to.mask = ~0u;
    to.id = to.flags = 0;
}

RTCRayHit closest(RTCScene scene, const Ray& ray) {
    RTCRayHit hit;
    set(hit.ray, ray);
    hit.hit.geomID = hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, &hit);
    return hit;
}

bool is_blocked(RTCScene scene, const Ray& ray) {
    RTCRay blocked;
    set(blocked, ray);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene, &context, &blocked);
    return blocked.tfar < 0;
}

// Marsaglia's xorshift, from 0 up to 1.
float random_number() {
    static uint64_t state = 0x2545f4914f6cdd1dull;
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return (state >> 40) * (1.0f / 16777216.0f);
}

// A direction about the normal, as likely as its cosine.
Vector scattered(Vector normal) {
    float angle = 6.2831853f * random_number(), z = 2 * random_number() - 1;
    float radius = std::sqrt(std::max(0.0f, 1 - z * z));
    return normalized(normal + Vector{radius * std::cos(angle), radius * std::sin(angle), z} * 0.9999f);
}

// Traces a ray, notes what is expected of it, and gives the point above the surface that it hit.
bool follow(RTCScene scene, Ray& ray, float lift, Vector& point, Vector& normal) {
    RTCRayHit hit = closest(scene, ray);
    bool hits = hit.hit.geomID != RTC_INVALID_GEOMETRY_ID;
    ray.expected = hits ? hit.ray.tfar : INFINITY;
    if (!hits) return false;
    normal = normalized({hit.hit.Ng_x, hit.hit.Ng_y, hit.hit.Ng_z});
    if (dot(normal, ray.direction) > 0) normal = normal * -1;
    point = ray.origin + ray.direction * hit.ray.tfar + normal * lift;
    return true;
}

void make_rays(char** words) {
    Mesh mesh = read_mesh(words[0]);
    std::string prefix = words[1];
    int edge = std::atoi(words[2]);
    float numbers[12];
    for (int i = 0; i < 12; i++) numbers[i] = std::atof(words[3 + i]);
    Vector eye{numbers[0], numbers[1], numbers[2]}, at{numbers[3], numbers[4], numbers[5]};
    float tangent = numbers[6], half = numbers[10], lift = numbers[11];
    Vector light{numbers[7], numbers[8], numbers[9]};
    Vector ahead = normalized(at - eye), right = normalized(cross(ahead, {0, 1, 0})), up = cross(right, ahead);
    Built built = build(mesh, true, 2);
    std::vector<Ray> primary, bounce1, bounce2, shadow;
    size_t wanted = size_t(edge) * edge;
    // Scenes with much sky need several passes until the later sets are full.
    for (int pass = 0; pass < 16 && std::min({bounce1.size(), bounce2.size(), shadow.size()}) < wanted; pass++) {
        // Tiles of 8 x 8, so that rays that follow each other are near each other.
        for (size_t index = 0; index < wanted; index++) {
            size_t tile = index / 64, inside = index % 64, tiles = edge / 8;
            float x = (tile % tiles) * 8 + inside % 8 + (pass ? random_number() : 0.5f);
            float y = (tile / tiles) * 8 + inside / 8 + (pass ? random_number() : 0.5f);
            Vector window = right * (tangent * (2 * x / edge - 1)) + up * (tangent * (1 - 2 * y / edge));
            Ray ray{eye, normalized(ahead + window), 1e30f, 0};
            Vector point, normal;
            bool hits = follow(built.scene, ray, lift, point, normal);
            if (!pass) primary.push_back(ray);
            if (!hits) continue;
            Vector goal = light + Vector{half * (2 * random_number() - 1), 0, half * (2 * random_number() - 1)};
            Vector way = goal - point;
            if (shadow.size() < wanted && dot(way, normal) > 0) {
                float distance = std::sqrt(dot(way, way));
                Ray question{point, way * (1 / distance), distance * 0.999f, 0};
                question.expected = is_blocked(built.scene, question) ? 0 : INFINITY;
                shadow.push_back(question);
            }
            Ray first{point, scattered(normal), 1e30f, 0};
            hits = follow(built.scene, first, lift, point, normal);
            if (bounce1.size() < wanted) bounce1.push_back(first);
            if (!hits || bounce2.size() >= wanted) continue;
            Ray second{point, scattered(normal), 1e30f, 0};
            follow(built.scene, second, lift, point, normal);
            bounce2.push_back(second);
        }
    }
    write_rays(prefix + ".primary", primary);
    write_rays(prefix + ".bounce1", bounce1);
    write_rays(prefix + ".bounce2", bounce2);
    write_rays(prefix + ".shadow", shadow);
    release(built);
}

// Million rays per CPU second, the median of several rounds, and how many answers differ from what is expected.
template <class Trace>
void measure_set(const char* key, const std::vector<Ray>& rays, int rounds, bool shadow, Trace trace) {
    std::vector<float> answers(rays.size());
    std::vector<double> rates;
    for (int round = 0; round <= rounds; round++) {
        double start = cpu_seconds(CLOCK_THREAD_CPUTIME_ID);
        trace(rays, answers);
        // The first warms up.
        if (round) rates.push_back(rays.size() / (cpu_seconds(CLOCK_THREAD_CPUTIME_ID) - start) * 1e-6);
    }
    std::sort(rates.begin(), rates.end());
    size_t different = 0;
    for (size_t i = 0; i < rays.size(); i++) {
        bool hits = answers[i] < 1e29f, expected = rays[i].expected < 1e29f;
        bool near = shadow || !hits || std::fabs(answers[i] - rays[i].expected) <= 2e-4f * std::max(rays[i].expected, 0.05f);
        different += hits != expected || !near;
    }
    std::printf("%s_mrays_per_cpu_second %.3f\n%s_different %zu\n", key, rates[rates.size() / 2], key, different);
}

// rtcIntersect16, told that the rays are coherent.
void closest16(RTCScene scene, const std::vector<Ray>& rays, std::vector<float>& answers) {
    for (size_t begin = 0; begin < rays.size(); begin += 16) {
        size_t count = std::min<size_t>(16, rays.size() - begin);
        alignas(64) int valid[16] = {};
        RTCRayHit16 hit;
        for (size_t i = 0; i < count; i++) {
            const Ray& ray = rays[begin + i];
            valid[i] = -1;
            hit.ray.org_x[i] = ray.origin.x;
            hit.ray.org_y[i] = ray.origin.y;
            hit.ray.org_z[i] = ray.origin.z;
            hit.ray.dir_x[i] = ray.direction.x;
            hit.ray.dir_y[i] = ray.direction.y;
            hit.ray.dir_z[i] = ray.direction.z;
            hit.ray.tnear[i] = hit.ray.time[i] = 0;
            hit.ray.tfar[i] = ray.largest;
            hit.ray.mask[i] = ~0u;
            hit.ray.id[i] = hit.ray.flags[i] = 0;
            hit.hit.geomID[i] = hit.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
        }
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        rtcIntersect16(valid, scene, &context, &hit);
        for (size_t i = 0; i < count; i++)
            answers[begin + i] = hit.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID ? INFINITY : hit.ray.tfar[i];
    }
}

void measure(char** words) {
    Mesh mesh = read_mesh(words[0]);
    std::string prefix = words[1];
    bool robust = std::strcmp(words[2], "robust") == 0;
    int rounds = std::max(1, std::atoi(words[3]));
    // One thread in CPU seconds, which others on the machine do not change; two in wall time, which is what they are for.
    for (int threads = 1; threads <= 2; threads++) {
        std::vector<double> seconds;
        double sum = 0;
        // A build of a small mesh takes a few milliseconds, of which single ones say little.
        while (seconds.size() < 3 || (seconds.size() < 25 && sum < 0.5)) {
            Built built = build(mesh, robust, threads);
            seconds.push_back(threads == 1 ? built.cpu : built.wall);
            sum += seconds.back();
            release(built);
        }
        std::sort(seconds.begin(), seconds.end());
        std::printf("%s %.3f\n", threads == 1 ? "build_mtriangles_per_cpu_second" : "build_mtriangles_per_second_2_threads",
                    mesh.triangle_count / seconds[seconds.size() / 2] * 1e-6);
    }
    Built built = build(mesh, robust, 2);
    std::printf("bytes_per_triangle %.1f\n", double(bytes) / mesh.triangle_count);
    auto single = [&](const std::vector<Ray>& rays, std::vector<float>& answers) {
        for (size_t i = 0; i < rays.size(); i++) {
            RTCRayHit hit = closest(built.scene, rays[i]);
            answers[i] = hit.hit.geomID == RTC_INVALID_GEOMETRY_ID ? INFINITY : hit.ray.tfar;
        }
    };
    auto any = [&](const std::vector<Ray>& rays, std::vector<float>& answers) {
        for (size_t i = 0; i < rays.size(); i++) answers[i] = is_blocked(built.scene, rays[i]) ? 0 : INFINITY;
    };
    auto packets = [&](const std::vector<Ray>& rays, std::vector<float>& answers) { closest16(built.scene, rays, answers); };
    for (const char* set : {"primary", "bounce1", "bounce2"})
        measure_set(set, read_rays(prefix + "." + set), rounds, false, single);
    measure_set("shadow", read_rays(prefix + ".shadow"), rounds, true, any);
    measure_set("primary_queue", read_rays(prefix + ".primary"), rounds, false, packets);
    release(built);
}

}  // namespace

int main(int count, char** words) {
    // As Embree's manual asks for.
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
    if (count == 17 && std::strcmp(words[1], "rays") == 0)
        make_rays(words + 2);
    else if (count == 6 && std::strcmp(words[1], "measure") == 0)
        measure(words + 2);
    else
        fail("see the first lines of this program");
}
