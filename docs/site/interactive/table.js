// The shader binding table as a toy: its bytes, and the record that a hit reads.
figures.add("table", figure => {
    const REGIONS = ["raygen", "miss", "hit"];
    const regions = REGIONS.map(name => {
        const region = figure.add(figure.stage, "span", "region");
        const label = figure.add(region, "span", "label", name);
        return { name, label, records: figure.add(region, "span", "records") };
    });
    const bytes = figure.add(figure.stage, "span", "legend");
    const counted = count => count === 1 ? "1 record" : `${count} records`;
    const up = (number, to) => Math.ceil(number / to) * to;

    return () => {
        const handle = figure.number("handle size");
        const data = [figure.number("raygen data"), 0, figure.number("data")];
        const records = [1, 1, figure.number("hit records")];
        const [alignment, base] = [figure.number("record alignment"), figure.number("region alignment")];
        const [instance, each] = [figure.number("instance"), figure.number("records an instance")];
        const geometry = figure.number("geometry");
        const [rayStride, rayOffset] = [figure.number("sbtRecordStride"), figure.number("sbtRecordOffset")];

        const strides = data.map(data => up(handle + data, alignment));
        const offsets = [];
        let size = 0;
        records.forEach((count, i) => {
            offsets.push(up(size, base));
            size = offsets[i] + count * strides[i];
        });
        const record = instance * each + geometry * rayStride + rayOffset;
        const at = offsets[2] + record * strides[2];
        const inside = record < records[2];
        // Whose record it is: an instance has its own from its offset on, which is where the next one's begin.
        const owner = Math.floor(record / each);
        figure.found = { strides, offsets, size, record, at, inside, owner };

        regions.forEach((region, i) => {
            region.label.textContent = `${region.name}: from byte ${offsets[i]}, ${counted(records[i])} of ${strides[i]} bytes`;
            region.records.replaceChildren();
            for (let number = 0; number < records[i]; number++) {
                const cell = figure.add(region.records, "span", "record", String(number));
                cell.style.setProperty("--handle", `${100 * handle / strides[i]}%`);
                cell.style.setProperty("--data", `${100 * (handle + data[i]) / strides[i]}%`);
                cell.classList.toggle("read", i === 2 && number === record);
            }
        });

        bytes.replaceChildren();
        let from = at;
        for (const [kind, until] of [["handle", at + handle], ["data", at + handle + data[2]], ["unused", at + strides[2]]]) {
            if (inside && until > from) {
                figure.add(bytes, "span", `key ${kind}`, `${kind}: bytes ${from} to ${until - 1}`);
            }
            from = until;
        }
        const steps = `record = instance ${instance} × ${counted(each)} + geometry ${geometry} × stride ${rayStride} `
            + `+ offset ${rayOffset} = ${record}, byte = ${offsets[2]} + ${record} × ${strides[2]} = ${at}.`;
        const other = ` Record ${record} belongs to instance ${owner}: the device reads it all the same.`;
        const outside = ` Error: the region has ${counted(records[2])} and ends at byte ${size}. `
            + "The device need not check that: it takes for a handle whatever lies there.";
        figure.said.classList.toggle("error", !inside);
        figure.said.textContent = steps + (!inside ? outside : owner === instance ? "" : other);
    };
});
